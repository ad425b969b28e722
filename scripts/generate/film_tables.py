"""Tables of the Reynolds film, one for all A.

The film depends on A = 4 w*/sqrt(2 h*) alone. All its quantities are analytic on the whole real line
of A and at both its ends, in powers of 1/A; they are singular at A = +-2i (tan x_e = +-i). The coordinate

    xi = A/(c + sqrt(A**2 + c**2)),   c = 3/2,   A = (c/2)(1/y - y),   y = (1 - xi)/(1 + xi)

maps the line to (-1, 1) and keeps the ends regular. Each quantity, divided by the product of powers of y and
1 + y that carries its behaviour at both ends, is interpolated at Chebyshev points in v = 2|xi| - 1,
separately for A < 0 (the teeth approach) and A >= 0, truncated, and turned into powers of v. On a half the
powers are as well conditioned as the Chebyshev polynomials, because the nearest singularity lies outside the
Bernstein ellipse of parameter 1 + sqrt(2). The tables hold the mean of both halves and half their difference:
a coefficient is then mean + sign(A) difference, which vectorises without masks and branches.

The piezo-viscous load is Psi = Phi (1 + (1 - sigma) S), sigma = sqrt(1 - B/B_crit), with S analytic in
sigma; its singularities next to [0, 1] are sigma = -1 and infinity, where the pressure group B changes sheet.
The Moebius map w = (3 + 2 sqrt(2)) (sigma + 1 - sqrt(2))/(sigma + 1 + sqrt(2)) sends [0, 1] to [-1, 1] and
these two to -+(3 + 2 sqrt(2)), so that a Chebyshev term in w is worth a factor of 11.6, twice that of a
linear map.
Integration by parts frees Psi of the logarithm and of cancellation:

    Psi = integral of (t - t_m)**2 (t_e - t) cos(x)**4/(1 - B p*) dx,   t = tan(x), t_m = -t_e - A.
"""

from film_functions import (
    COMMAND,
    SCALE,
    Film,
    array_text,
    chebyshev_coefficients,
    chebyshev_nodes,
    powers,
)
from mpmath import mp, mpf

TERMS = 30
NODES = 56
PIEZO_NODES = (44, 28)
PIEZO_TERMS = (24, 16)
PIEZO_ROWS = [24] * 5 + [16] * 5 + [8] * 6


def group_at(v, side):
    """Group A, its root scale and y at the table coordinate v of the half side = -1 or +1."""
    c = mpf(SCALE)
    xi = side * (1 + v) / 2
    y = (1 - xi) / (1 + xi)
    a = c / 2 * (1 / y - y)
    return a, mp.sqrt(a * a + c * c), y


def iso_tables():
    """Six scaled quantities, each as two columns of ascending powers of v."""
    half = mpf(SCALE) / 2
    tables = {name: [] for name in ("tangent", "tangent_slope", "load", "load_slope", "peak", "peak_slope")}
    for side in (-1, 1):
        rows = {name: [] for name in tables}
        for v in chebyshev_nodes(NODES):
            a, s, y = group_at(v, side)
            film = Film(a)
            share = y / (1 + y)
            rows["tangent"].append(film.t / s)
            rows["tangent_slope"].append(film.dt)
            rows["load"].append(film.phi / (half * y * share))
            rows["load_slope"].append(film.dphi / share**3)
            rows["peak"].append(film.peak / (half * y * share**2))
            rows["peak_slope"].append(film.dpeak / share**4)
        for name, values in rows.items():
            tables[name].append(powers(chebyshev_coefficients(values, TERMS)))
    return tables


def tanh_sinh(step, count):
    """Nodes and weights of the tanh-sinh rule on [-1, 1]."""
    rule = []
    for k in range(-count, count + 1):
        u = k * step
        inner = mp.pi / 2 * mp.sinh(u)
        rule.append((mp.tanh(inner), step * mp.pi / 2 * mp.cosh(u) / mp.cosh(inner) ** 2))
    return rule


def piezo_excess(film, sigmas, rule):
    """S = (Psi/Phi - 1)/(1 - sigma) at one A for several sigma."""
    samples = []
    for low, high in ((-mp.pi / 2, film.x_m), (film.x_m, film.x)):
        for node, weight in rule:
            x = (low + high) / 2 + (high - low) / 2 * node
            t = mp.tan(x)
            kernel = (t - film.t_m) ** 2 * (film.t - t) * mp.cos(x) ** 4
            samples.append((weight * (high - low) / 2 * kernel, film.pressure(x) / film.peak))
    if abs(mp.fsum(w for w, _ in samples) / film.phi - 1) > mpf(10) ** -30:
        raise ArithmeticError(f"quadrature misses the iso-viscous load at A = {film.a}")
    result = []
    for sigma in sigmas:
        share = 1 - sigma * sigma
        psi = mp.fsum(w / (1 - share * q) for w, q in samples)
        result.append((psi / film.phi - 1) / (1 - sigma))
    return result


def sigma_nodes(count):
    """Values of sigma at the Chebyshev points of the table coordinate w."""
    root = mp.sqrt(2)
    edge = 3 + 2 * root
    return [(edge * (root - 1) + w * (root + 1)) / (edge - w) for w in chebyshev_nodes(count)]


def piezo_table():
    """Both halves of S: table[half][power of v][power of w]."""
    rule = tanh_sinh(mpf(1) / 32, 112)
    count_v, count_w = PIEZO_NODES
    terms_v, terms_w = PIEZO_TERMS
    sigmas = sigma_nodes(count_w)
    halves = []
    for side in (-1, 1):
        rows = []
        for v in chebyshev_nodes(count_v):
            a, _, _ = group_at(v, side)
            rows.append(chebyshev_coefficients(piezo_excess(Film(a), sigmas, rule), terms_w))
        columns = []
        for j in range(terms_w):
            keep = PIEZO_ROWS[j]
            kept = powers(chebyshev_coefficients([row[j] for row in rows], keep))
            columns.append(kept + [mpf(0)] * (terms_v - keep))
        halves.append([powers([columns[j][i] for j in range(terms_w)]) for i in range(terms_v)])
    return halves


def mean_and_difference(approach, separation):
    """Mean of two lists of coefficients and half their difference, coefficient by coefficient."""
    pairs = list(zip(approach, separation, strict=True))
    return [(p + q) / 2 for p, q in pairs], [(q - p) / 2 for p, q in pairs]


def iso_module():
    """Text of module iso_viscous_coefficients."""
    meaning = {
        "tangent": "t_e/sqrt(A**2 + c**2)",
        "tangent_slope": "dt_e/dA",
        "load": "Phi (1 + y)/(c y**2/2)",
        "load_slope": "dPhi/dA ((1 + y)/y)**3",
        "peak": "max p* (1 + y)**2/(c y**3/2)",
        "peak_slope": "d(max p*)/dA ((1 + y)/y)**4",
    }
    text = [
        "!> Generated tables of the exact iso-viscous film (Swift-Stieber rupture). Do not edit.",
        f"!> Made by: {COMMAND}",
        "!>",
        "!> Ascending powers of v = 2|xi| - 1, xi = A/(c + sqrt(A**2 + c**2)). A coefficient is column 1",
        "!> plus sign(A) times column 2. The script derives the scaling, y = (1 - xi)/(1 + xi).",
        "module iso_viscous_coefficients",
        "   use kinds, only: dp",
        "   implicit none (type, external)",
        "   private",
        "",
        "   !> Scale c of the coordinate xi [-].",
        f"   real(dp), parameter, public :: coordinate_scale = {SCALE}_dp",
        "   !> Highest power of v in the tables.",
        f"   integer, parameter, public :: iso_degree = {TERMS - 1}",
    ]
    for name, columns in iso_tables().items():
        body = array_text([v for column in mean_and_difference(*columns) for v in column])
        text += [
            "",
            f"   !> {meaning[name]}",
            f"   real(dp), parameter, public :: {name}_table(0:iso_degree, 2) = reshape([ &",
            f"      {body}], &",
            "      [iso_degree + 1, 2])",
        ]
    return "\n".join([*text, "", "end module iso_viscous_coefficients", ""])


def piezo_module(halves):
    """Text of module piezo_viscous_coefficients."""
    terms_v, terms_w = PIEZO_TERMS
    text = [
        "!> Generated tables of the exact piezo-viscous film (Barus oil). Do not edit.",
        f"!> Made by: {COMMAND}",
        "!>",
        "!> Psi = Phi (1 + (1 - sigma) S), sigma = sqrt(1 - B/B_crit); S in ascending powers of",
        "!> w = (3 + 2 sqrt(2)) (sigma + 1 - sqrt(2))/(sigma + 1 + sqrt(2)) (first index) and of",
        "!> v = 2|xi| - 1 (second index), see module iso_viscous_coefficients for xi.",
        "!> A coefficient is that of mean_table plus sign(A) times that of difference_table.",
        "module piezo_viscous_coefficients",
        "   use kinds, only: dp",
        "   implicit none (type, external)",
        "   private",
        "",
        "   !> Highest power of w.",
        f"   integer, parameter, public :: sigma_degree = {terms_w - 1}",
        "   !> Highest power of v.",
        f"   integer, parameter, public :: group_degree = {terms_v - 1}",
        "   !> Highest power of v that goes with each power of w.",
        "   integer, parameter, public :: row_degree(0:sigma_degree) = [ &",
        f"      {', '.join(str(count - 1) for count in PIEZO_ROWS)}]",
    ]
    flat = [[v for row in rows for v in row] for rows in halves]
    for name, values in zip(("mean", "difference"), mean_and_difference(*flat), strict=True):
        text.append("")
        text.append(
            f"   real(dp), parameter, public :: {name}_table(0:sigma_degree, 0:group_degree) = reshape([ &"
        )
        text.append(f"      {array_text(values)}], &")
        text.append("      [sigma_degree + 1, group_degree + 1])")
    return "\n".join([*text, "", "end module piezo_viscous_coefficients", ""])
