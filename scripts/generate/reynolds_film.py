"""Generate the coefficient tables of the exact (Swift-Stieber) film.

Write:  python scripts/generate/reynolds_film.py
Check:  python scripts/generate/reynolds_film.py --check

The check recomputes the modules and compares them byte for byte with the files in fsrc/film/coefficients.

Method. The film depends on A = 4 w*/sqrt(2 h*) alone. All its quantities are analytic on the whole real line
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

Taylor series of the motion need the derivatives of Phi(A), which no coordinate but A itself gives away. Phi,
and the load of the published film with its rupture solved, are therefore tabulated once more, as polynomials
in A on pieces of the line, four from each 2 + |A| = 2**n to the next. No piece is longer than a quarter of
its distance from +-2i, so a term of its Chebyshev series is worth a factor of 17, and the polynomial can be
followed well beyond its piece, as a step of the motion does.
"""

import argparse
import sys
from pathlib import Path

from mpmath import mp, mpf

ROOT = Path(__file__).resolve().parents[2]
TARGET = ROOT / "fsrc" / "film" / "coefficients"
COMMAND = "python scripts/generate/reynolds_film.py"

DIGITS = 80
SCALE = "1.5"
TERMS = 30
NODES = 56
PIEZO_NODES = (44, 28)
PIEZO_TERMS = (24, 16)
PIEZO_ROWS = [24] * 5 + [16] * 5 + [8] * 6
PIECE_DEGREE = 12
PIECE_NODES = 18
OCTAVE_PIECES = 4
OCTAVES = 24
ARRAY_OCTAVES = 8


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
    """Exact film at one A: rupture, load, peak pressure and their slopes."""

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


def piezo_table():
    """Both halves of S: table[half][power of v][power of w]."""
    rule = tanh_sinh(mpf(1) / 32, 112)
    count_v, count_w = PIEZO_NODES
    terms_v, terms_w = PIEZO_TERMS
    root = mp.sqrt(2)
    edge = 3 + 2 * root
    sigmas = [(edge * (root - 1) + w * (root + 1)) / (edge - w) for w in chebyshev_nodes(count_w)]
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


def piezo_module():
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
    flat = [[v for row in rows for v in row] for rows in piezo_table()]
    for name, values in zip(("mean", "difference"), mean_and_difference(*flat), strict=True):
        text.append("")
        text.append(
            f"   real(dp), parameter, public :: {name}_table(0:sigma_degree, 0:group_degree) = reshape([ &"
        )
        text.append(f"      {array_text(values)}], &")
        text.append("      [sigma_degree + 1, group_degree + 1])")
    return "\n".join([*text, "", "end module piezo_viscous_coefficients", ""])


def exact_load(a):
    """Phi of the exact film, eq (21) corrected."""
    return Film(a).phi


def published_load(a):
    """Load of the published film (24), rupture solved, over its rolling term."""
    return 1 - 3 / (4 * mpf("2.8")) * a * (Film(a).x + mp.pi / 2)


def piece_row(load, side, octave, piece):
    """Centre, inverse unit and coefficients of ascending powers of (A - centre)/unit on one piece."""
    low, high = (mpf(2) ** (octave + 1) * (1 + mpf(piece + i) / OCTAVE_PIECES) - 2 for i in (0, 1))
    centre, half, unit = (low + high) / 2, (high - low) / 2, mpf(2) ** octave
    values = [load(side * (centre + half * node)) for node in chebyshev_nodes(PIECE_NODES)]
    factors = powers(chebyshev_coefficients(values, PIECE_DEGREE + 1))
    return [side * centre, 1 / unit, *(f * (side * unit / half) ** j for j, f in enumerate(factors))]


def end_row(load, side):
    """The straight line beyond the last piece: the limit of a load on separation is a constant."""
    start = side * (mpf(2) ** (OCTAVES + 1) - 2)
    slope = 0 if side > 0 else (load(2 * start) - load(start)) / start
    return [start, mpf(1), load(start), slope] + [mpf(0)] * (PIECE_DEGREE - 1)


def piece_arrays(name, load):
    """Arrays of the pieces of one load, and their names."""
    text, names = [], []
    for side, word in ((1, "separation"), (-1, "approach")):
        for first in range(0, OCTAVES, ARRAY_OCTAVES):
            rows = [
                piece_row(load, side, octave, piece)
                for octave in range(first, first + ARRAY_OCTAVES)
                for piece in range(OCTAVE_PIECES)
            ]
            names.append(f"{name}_{word}_{first // ARRAY_OCTAVES + 1}")
            text += piece_array(names[-1], rows)
        names.append(f"{name}_{word}_end")
        text += piece_array(names[-1], [end_row(load, side)])
    return text, names


def piece_array(name, rows):
    """One array of rows."""
    body = array_text([v for row in rows for v in row], 4)
    return ["", f"   real(dp), parameter :: {name}({len(rows) * len(rows[0])}) = [ &", f"      {body}]"]


def pieces_module():
    """Text of module load_pieces."""
    text = [
        "!> Generated pieces of the load of films with rupture, for their Taylor series. Do not edit.",
        f"!> Made by: {COMMAND}",
        "!>",
        "!> A piece: its centre, one over its unit, and the load in ascending powers of (A - centre)/unit.",
        "!> From each 2 + |A| = 2**n on, octave_pieces of equal length up to the next. First the pieces of",
        "!> A >= 0, from 0 on; the last one is a straight line without end. Then those of A < 0, from -0 on.",
        "module load_pieces",
        "   use kinds, only: dp",
        "   implicit none (type, external)",
        "   private",
        "",
        "   !> Loads: Phi of the exact film, eq (21) corrected; the published one, eq (24) with its rupture",
        "   !> from (18), over its rolling term.",
        "   integer, parameter, public :: exact_load = 1, published_load = 2",
        "   !> Highest power in a piece.",
        f"   integer, parameter, public :: piece_degree = {PIECE_DEGREE}",
        "   !> Pieces in an octave of 2 + |A|, and number of the last one, counted from 0.",
        f"   integer, parameter, public :: octave_pieces = {OCTAVE_PIECES}",
        f"   integer, parameter, public :: last_piece = {OCTAVES * OCTAVE_PIECES}",
    ]
    names = []
    for name, load in (("exact", exact_load), ("published", published_load)):
        arrays, parts = piece_arrays(name, load)
        text += arrays
        names += parts
    body = ", &\n      ".join(", ".join(names[i : i + 4]) for i in range(0, len(names), 4))
    text += [
        "",
        "   !> Centre, one over unit and coefficients; piece; load.",
        "   real(dp), parameter, public :: pieces(-2:piece_degree, 0:2*last_piece + 1, 2) = reshape([ &",
        f"      {body}], &",
        "      [piece_degree + 3, 2*last_piece + 2, 2])",
    ]
    return "\n".join([*text, "", "end module load_pieces", ""])


def main() -> int:
    """Write the modules, or compare them with the files."""
    parser = argparse.ArgumentParser(description="Coefficient tables of the exact film.")
    parser.add_argument("--check", action="store_true", help="compare with the files instead of writing them")
    arguments = parser.parse_args()
    mp.dps = DIGITS
    status = 0
    for name, make in (
        ("iso_viscous_coefficients", iso_module),
        ("piezo_viscous_coefficients", piezo_module),
        ("load_pieces", pieces_module),
    ):
        path = TARGET / f"{name}.f90"
        text = make()
        if not arguments.check:
            path.write_text(text)
            print(f"wrote {path.relative_to(ROOT)}")
        elif not path.exists() or path.read_text() != text:
            print(f"{path.relative_to(ROOT)} differs from what its generator makes", file=sys.stderr)
            status = 1
        else:
            print(f"{path.relative_to(ROOT)} is reproduced byte for byte")
    return status


if __name__ == "__main__":
    sys.exit(main())
