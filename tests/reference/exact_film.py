"""Exact (Swift-Stieber) film in arbitrary precision: the measure of the Fortran kernels.

Every function takes A = 4 w*/sqrt(2 h*), and B = 6 sqrt(2) u*/h***1.5, as number or string and returns mpmath
numbers. Rupture, Phi and B_crit come from the closed forms with enough digits to outlast their cancellation.
Psi and its slopes are integrals of the pressure as defined,

    p*(x) = J(x) - t_e**2 K(x) - A (cos(x)**4/4 + t_e K(x)),   t = tan(x),
    Psi = (1/B) integral of -ln(1 - B p*) dt   from t = -infinity to t_e,

not the transformed integral from which the Fortran tables are made. At B = 0 they are Phi, a check of both.
"""

from typing import NamedTuple

from mpmath import mp, mpf

DIGITS = 30


class Film(NamedTuple):
    """Rupture, peak pressure and their slopes at one A."""

    a: mpf
    tangent: mpf
    tangent_slope: mpf
    angle: mpf
    peak_angle: mpf
    peak: mpf
    peak_slope: mpf


def _digits_for(a: mpf) -> int:
    """Working digits: near x = -pi/2 the closed forms lose up to five powers of A."""
    return DIGITS + 15 + 6 * max(0, int(mp.ceil(mp.log10(1 + abs(a)))))


def _moments(x):
    s2, s4 = mp.sin(2 * x), mp.sin(4 * x)
    return x / 8 - s4 / 32 + mp.pi / 16, 3 * x / 8 + s2 / 4 + s4 / 32 + 3 * mp.pi / 16


def _pressure(a, t_e, x):
    j, k = _moments(x)
    return j - t_e**2 * k - a * (mp.cos(x) ** 4 / 4 + t_e * k)


def _pressure_slope(a, t_e, slope, x):
    """Slope dp*/dA at fixed x."""
    _, k = _moments(x)
    return -(mp.cos(x) ** 4 / 4 + t_e * k) - (2 * t_e + a) * slope * k


def film(a) -> Film:
    """Rupture root t_e > -A/2 by bisection, finished by Newton steps, and what follows from it."""
    a = mpf(a)
    with mp.workdps(_digits_for(a)):

        def excess(t):
            x = mp.atan(t)
            j, k = _moments(x)
            return j - t * t * k - a * (mp.cos(x) ** 4 / 4 + t * k)

        # p*(x_e) is positive just right of the peak, t = -A/2, and negative far out.
        low, high = -a / 2, abs(a) + 1
        for _ in range(12):
            middle = (low + high) / 2
            low, high = (middle, high) if excess(middle) > 0 else (low, middle)
        tolerance = mpf(10) ** (-2 * mp.dps + 10)
        t = mp.findroot(excess, (low, high), solver="anderson", tol=tolerance, verify=False)
        for _ in range(3):
            _, k = _moments(mp.atan(t))
            t += excess(t) / (k * (2 * t + a))
        x = mp.atan(t)
        _, k = _moments(x)
        slope = -(mp.cos(x) ** 4 / 4 + t * k) / (k * (2 * t + a))
        x_m = mp.atan(-t - a)
        return Film(a, t, slope, x, x_m, _pressure(a, t, x_m), _pressure_slope(a, t, slope, x_m))


def iso_load(a):
    """Load group Phi and slope dPhi/dA from the closed forms."""
    f = film(a)
    with mp.workdps(_digits_for(f.a)):
        c, x = mp.cos(f.angle), f.angle
        _, k = _moments(x)
        swept = x + mp.pi / 2 + mp.sin(x) * c
        return c**2 / 4 - f.a / 8 * swept, -swept / 8 + (c**4 / 4) * (c**4 / 4 + f.tangent * k) / k


def critical_pressure_group(a):
    """B_crit = 1/max p*, up to which a rigid piezo-viscous film exists."""
    return 1 / film(a).peak


def piezo_load(a, b):
    """Psi, dPsi/dA and dPsi/dB by quadrature of the pressure and of its slopes."""
    f = film(a)
    b = mpf(b)
    if not 0 <= b * f.peak < 1:
        raise ValueError("no rigid piezo-viscous film")
    with mp.workdps(_digits_for(f.a)):
        # Panels shrink towards the peak, down to the width over which 1 - B p* keeps near its minimum.
        # Gauss-Legendre, because nodes as near to -pi/2 as those of tanh-sinh would lose p* to cancellation.
        width = mp.sqrt(1 - b * f.peak)
        fractions = [mpf(1)]
        while fractions[-1] > width:
            fractions.append(fractions[-1] / 4)
        left, right = f.peak_angle + mp.pi / 2, f.angle - f.peak_angle
        cuts = [f.peak_angle - left * q for q in fractions]
        cuts += [f.peak_angle, *(f.peak_angle + right * q for q in reversed(fractions[1:]))]
        # On fast approach the pressure falls to zero in a layer of width 1/|A| before the rupture.
        layer = mpf(1) / 2
        while layer * (1 + abs(f.a)) > 1:
            cuts.append(f.angle - right * layer)
            layer /= 4
        cuts = sorted({*cuts, f.angle})

        def integral(g):
            def integrand(x):
                return g(x, _pressure(f.a, f.tangent, x)) / mp.cos(x) ** 2

            return mp.quad(integrand, cuts, method="gauss-legendre", maxdegree=5)

        def slope(x):
            return _pressure_slope(f.a, f.tangent, f.tangent_slope, x)

        if b == 0:
            psi = integral(lambda _, p: p)
            dpsi_db = integral(lambda _, p: p * p / 2)
        else:
            psi = integral(lambda _, p: -mp.log1p(-b * p) / b)
            dpsi_db = integral(lambda _, p: (p / (1 - b * p) + mp.log1p(-b * p) / b) / b)
        dpsi_da = integral(lambda x, p: slope(x) / (1 - b * p))
        return psi, dpsi_da, dpsi_db
