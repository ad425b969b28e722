"""The exact (Swift-Stieber) film at one squeeze group A, Chebyshev sums, and literals of Fortran."""

from mpmath import mp, mpf

DIGITS = 80
SCALE = "1.5"
COMMAND = "python scripts/generate/reynolds_film.py"


def moments(x):
    """Integrals of sin^2 cos^2 and of cos^4 from -pi/2 to x."""
    double, quadruple = mp.sin(2 * x), mp.sin(4 * x)
    j = x / 8 - quadruple / 32 + mp.pi / 16
    k = 3 * x / 8 + double / 4 + quadruple / 32 + 3 * mp.pi / 16
    return j, k


def rupture_tangent(a):
    """Physical root t_e > -A/2 of the rupture condition, by Newton's method from the asymptotes."""
    t = (5 * mp.sqrt(a * a + 2) - 11 * a) / 16
    for _ in range(100):
        x = mp.atan(t)
        j, k = moments(x)
        quarter = mp.cos(x) ** 4 / 4
        step = (j - t * t * k - a * (quarter + t * k)) / (k * (2 * t + a))
        if t + step <= -a / 2:
            t = (t - a / 2) / 2
            continue
        t += step
        if abs(step) < mpf(10) ** (-DIGITS // 2) * (1 + abs(t)):
            return t
    raise ArithmeticError(f"no rupture root at A = {a}")


class Film:
    """Reynolds film at one A: rupture, load, peak pressure and their slopes."""

    def __init__(self, a):
        self.a = a
        self.t = t = rupture_tangent(a)
        self.x = x = mp.atan(t)
        _, k = moments(x)
        quarter = mp.cos(x) ** 4 / 4
        swept = x + mp.pi / 2 + mp.sin(x) * mp.cos(x)
        self.phi = mp.cos(x) ** 2 / 4 - a / 8 * swept
        self.dphi = -swept / 8 + quarter * (quarter + t * k) / k
        self.dt = -(quarter + t * k) / (k * (2 * t + a))
        self.t_m = -t - a
        self.x_m = mp.atan(self.t_m)
        _, k_m = moments(self.x_m)
        self.peak = self.pressure(self.x_m)
        self.dpeak = -(mp.cos(self.x_m) ** 4 / 4 + t * k_m) - k_m * (2 * t + a) * self.dt

    def pressure(self, x):
        """Dimensionless pressure p* at the film angle x."""
        j, k = moments(x)
        return j - self.t**2 * k - self.a * (mp.cos(x) ** 4 / 4 + self.t * k)


def chebyshev_nodes(count):
    """Zeros of the Chebyshev polynomial of degree count."""
    return [mp.cos((2 * i + 1) * mp.pi / (2 * count)) for i in range(count)]


def chebyshev_coefficients(values, terms):
    """First coefficients of the Chebyshev interpolant through values at chebyshev_nodes."""
    count = len(values)
    angles = [(2 * i + 1) * mp.pi / (2 * count) for i in range(count)]
    return [
        mp.fsum(f * mp.cos(j * angle) for f, angle in zip(values, angles, strict=True))
        * (2 if j else 1)
        / count
        for j in range(terms)
    ]


def powers(coefficients):
    """Turn a Chebyshev sum into coefficients of ascending powers."""
    terms = len(coefficients)
    result = [mpf(0)] * terms
    previous, current = [mpf(1)], [mpf(0), mpf(1)]
    for j, c in enumerate(coefficients):
        for power, factor in enumerate(previous):
            result[power] += c * factor
        following = [mpf(0)] + [2 * f for f in current]
        for power, factor in enumerate(previous):
            following[power] -= factor
        previous, current = current, following
        if j + 1 == terms:
            break
    return result


def literal(value):
    """Fortran literal of the nearest double: the shortest one that reads back the same."""
    number = float(value)
    if number == 0:
        return "0.0_dp"
    words = (f"{number:.{digits}e}" for digits in range(1, 17))
    return next(word for word in words if float(word) == number) + "_dp"


def array_text(values, a_line=3):
    """Comma separated literals, some a line, continued."""
    words = [literal(v) for v in values]
    lines = [", ".join(words[i : i + a_line]) for i in range(0, len(words), a_line)]
    return ", &\n      ".join(lines)
