"""Tables of the Reynolds film for Taylor series of the motion: polynomials in A, and in A and sigma.

Taylor series of the motion need the derivatives of Phi(A), which no coordinate but A itself gives away. Phi,
and the load of the published film with its rupture solved, are therefore tabulated once more, as polynomials
in A on pieces of the line, four from each 2 + |A| = 2**n to the next. No piece is longer than a quarter of
its distance from +-2i, so a term of its Chebyshev series is worth a factor of 17, and the polynomial can be
followed well beyond its piece, as a step of the motion does.

With elastic teeth the load is known and A is not. The inverse is tabulated, too: A as polynomials
in the load less its limit on separation, four pieces from each power of two to the next.

For the piezo-viscous film the same is done in A and sigma, in cells: powers of both up to a total degree,
about the centre of a piece of A and an interval of sigma, from the table of S in film_tables. They are good
to 1e-11, enough for a Taylor series of the motion, and reach to |A| = 14. max p*(A), which leads to
sigma, goes with them. Zeros fill their rows up to whole registers, in which rows of several lanes are taken
side by side.
"""

from film_functions import (
    COMMAND,
    DIGITS,
    SCALE,
    Film,
    array_text,
    chebyshev_coefficients,
    chebyshev_nodes,
    moments,
    powers,
)
from mpmath import mp, mpf

PIECE_DEGREE = 12
PIECE_NODES = 18
OCTAVE_PIECES = 4
OCTAVES = 24
LOAD_OCTAVES = range(-32, 16)
ARRAY_OCTAVES = 8
ARRAY_ROWS = ARRAY_OCTAVES * OCTAVE_PIECES
CELL_DEGREE = 9
CELL_NODES = 14
CELL_OCTAVE_PIECES = 6
CELL_OCTAVES = 3
SIGMA_CELLS = 5
REGISTER = 8


def exact_load(a):
    """Phi of the Reynolds film, eq (21) corrected."""
    return Film(a).phi


def published_load(a):
    """Load of the published film (24), rupture solved, over its rolling term."""
    return 1 - 3 / (4 * mpf("2.8")) * a * (Film(a).x + mp.pi / 2)


def exact_of_tangent(t):
    """A and Phi of the Reynolds film whose tangent of the rupture angle is t, and the slopes of both."""
    a, slope, x = group_of_tangent(t)
    swept = x + mp.pi / 2 + mp.sin(x) * mp.cos(x)
    quarter = mp.cos(x) ** 4 / 4
    load = mp.cos(x) ** 2 / 4 - a / 8 * swept
    return a, load, slope, slope * (-swept / 8 + quarter * (quarter + t * moments(x)[1]) / moments(x)[1])


def published_of_tangent(t):
    """The same of the published film, its load less the limit on separation."""
    a, slope, x = group_of_tangent(t)
    factor = 3 / (4 * mpf("2.8"))
    width = x + mp.pi / 2
    return a, factor * (mpf(8) / 3 - a * width), slope, -factor * (slope * width + a / (1 + t * t))


def group_of_tangent(t):
    """A of the rupture condition, its slope, and the rupture angle."""
    x = mp.atan(t)
    j, k = moments(x)
    quarter = mp.cos(x) ** 4 / 4
    a = (j - t * t * k) / (quarter + t * k)
    return a, -k * (2 * t + a) / (quarter + t * k), x


def group_of_load(load_of_tangent, wanted, t):
    """A at which a load has a value, and the tangent there: Newton's method for its logarithm, from t."""
    place = mp.asinh(t)
    for _ in range(200):
        t = mp.sinh(place)
        a, load, _, slope = load_of_tangent(t)
        step = load * mp.log(load / wanted) / (slope * mp.cosh(place))
        if abs(step) < mpf(10) ** (-DIGITS // 3):
            return a, t
        place -= max(min(step, 1), -1)
    raise ArithmeticError(f"no film carries {wanted}")


def squeeze_rows(load_of_tangent):
    """Rows of A in powers of the load: centre, inverse unit and coefficients of each piece."""
    rows, t = [], mpf(0)
    for octave in LOAD_OCTAVES:
        for piece in range(OCTAVE_PIECES):
            unit = mpf(2) ** octave
            half = unit / (2 * OCTAVE_PIECES)
            centre = unit + (2 * piece + 1) * half
            values = []
            for node in chebyshev_nodes(PIECE_NODES):
                a, t = group_of_load(load_of_tangent, centre + half * node, t)
                values.append(a)
            factors = powers(chebyshev_coefficients(values, PIECE_DEGREE + 1))
            rows.append(filled([centre, 1 / unit, *(f * (unit / half) ** j for j, f in enumerate(factors))]))
    return rows


def piece_of(side, octave, piece, octave_pieces):
    """Centre and half length of a piece, both with the sign of its side, and its unit."""
    low, high = (mpf(2) ** (octave + 1) * (1 + mpf(piece + i) / octave_pieces) - 2 for i in (0, 1))
    return side * (low + high) / 2, side * (high - low) / 2, mpf(2) ** octave


def piece_row(load, side, octave, piece):
    """Centre, inverse unit and coefficients of ascending powers of (A - centre)/unit on one piece."""
    centre, half, unit = piece_of(side, octave, piece, OCTAVE_PIECES)
    values = [load(centre + half * node) for node in chebyshev_nodes(PIECE_NODES)]
    factors = powers(chebyshev_coefficients(values, PIECE_DEGREE + 1))
    return filled([centre, 1 / unit, *(f * (unit / half) ** j for j, f in enumerate(factors))])


def end_row(load, side):
    """The straight line beyond the last piece: the limit of a load on separation is a constant."""
    start = side * (mpf(2) ** (OCTAVES + 1) - 2)
    slope = 0 if side > 0 else (load(2 * start) - load(start)) / start
    return filled([start, mpf(1), load(start), slope] + [mpf(0)] * (PIECE_DEGREE - 1))


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
        "   !> Loads: Phi of the Reynolds film, (21) corrected; the published one, (24) with its rupture",
        "   !> from (18), over its rolling term.",
        "   integer, parameter, public :: exact_load = 1, published_load = 2",
        "   !> Their limits when the film separates fast",
        "   real(dp), parameter, public :: load_limit(2) = [0.0_dp, 2.0_dp/7.0_dp]",
        "   !> Highest power in a piece.",
        f"   integer, parameter, public :: piece_degree = {PIECE_DEGREE}",
        "   !> Numbers of a piece; those beyond the coefficients are zero.",
        f"   integer, parameter, public :: piece_size = {len(end_row(exact_load, 1))}",
        "   !> Pieces in an octave of 2 + |A|, and number of the last one, counted from 0.",
        f"   integer, parameter, public :: octave_pieces = {OCTAVE_PIECES}",
        f"   integer, parameter, public :: last_piece = {OCTAVES * OCTAVE_PIECES}",
        "   !> The inverse, A of the load: A in ascending powers of (load - limit - centre)/unit. Binary",
        "   !> logarithm of the least load, and number of the last piece, counted from 0.",
        f"   integer, parameter, public :: first_load = {LOAD_OCTAVES[0]}",
        f"   integer, parameter, public :: last_load_piece = {len(LOAD_OCTAVES) * OCTAVE_PIECES - 1}",
    ]
    names = []
    for name, load in (("exact", exact_load), ("published", published_load)):
        arrays, parts = piece_arrays(name, load)
        text += arrays
        names += parts
    turned = []
    for name, load_of_tangent in (("exact", exact_of_tangent), ("published", published_of_tangent)):
        rows = squeeze_rows(load_of_tangent)
        for first in range(0, len(rows), ARRAY_ROWS):
            turned.append(f"{name}_squeeze_{first // ARRAY_ROWS + 1}")
            text += piece_array(turned[-1], rows[first : first + ARRAY_ROWS])
    squeezes = ", &\n      ".join(", ".join(turned[i : i + 4]) for i in range(0, len(turned), 4))
    body = ", &\n      ".join(", ".join(names[i : i + 4]) for i in range(0, len(names), 4))
    text += [
        "",
        "   !> Centre, one over unit and coefficients of A in powers of the load; piece; load.",
        "   real(dp), parameter, public :: squeezes(piece_size, 0:last_load_piece, 2) = reshape([ &",
        f"      {squeezes}], &",
        "      [piece_size, last_load_piece + 1, 2])",
        "",
        "   !> Centre, one over unit and coefficients; piece; load.",
        "   real(dp), parameter, public :: pieces(piece_size, 0:2*last_piece + 1, 2) = reshape([ &",
        f"      {body}], &",
        "      [piece_size, 2*last_piece + 2, 2])",
    ]
    return "\n".join([*text, "", "end module load_pieces", ""])


def column_at(half, a):
    """S(A, .) as coefficients of ascending powers of the table coordinate w, from one half of the table."""
    xi = abs(a) / (mpf(SCALE) + mp.sqrt(a * a + mpf(SCALE) ** 2))
    powers_of_v = [(2 * xi - 1) ** i for i in range(len(half))]
    return [mp.fdot(powers_of_v, [row[j] for row in half]) for j in range(len(half[0]))]


def cell_rows(halves, side, octave, piece):
    """Row of max p* and rows of the cells of one piece: powers of (A - centre)/unit and sigma - centre."""
    centre, half, unit = piece_of(side, octave, piece, CELL_OCTAVE_PIECES)
    films = [Film(centre + half * node) for node in chebyshev_nodes(CELL_NODES)]
    columns = [column_at(halves[0 if side < 0 else 1], film.a) for film in films]
    peak = powers(chebyshev_coefficients([film.peak for film in films], CELL_DEGREE + 1))
    rows = [filled([centre, 1 / unit, *(f * (unit / half) ** i for i, f in enumerate(peak))])]
    width = mpf(1) / SIGMA_CELLS
    for cell in range(SIGMA_CELLS):
        sigmas = [width * (cell + (1 + node) / 2) for node in chebyshev_nodes(CELL_NODES)]
        values = [
            [film.phi * (1 + (1 - s) * mp.polyval(column[::-1], table_w(s))) for s in sigmas]
            for film, column in zip(films, columns, strict=True)
        ]
        rows.append(cell_row(values, unit / half, 2 / width))
    return rows


def cell_row(values, scale_a, scale_sigma):
    """Coefficients of one cell, up to a total degree, from values at chebyshev_nodes.

    They are rounded to what is worth 1e-15 a third of a unit of A and a quarter of sigma away.
    """
    sums = [chebyshev_coefficients(row, CELL_DEGREE + 1) for row in values]
    kept = [
        powers(chebyshev_coefficients([row[j] for row in sums], CELL_DEGREE + 1 - j))
        for j in range(CELL_DEGREE + 1)
    ]
    for i in range(CELL_DEGREE + 1):
        for j, f in enumerate(powers([kept[j][i] for j in range(CELL_DEGREE + 1 - i)])):
            quantum = mpf(10) ** -int(15 - i * mp.log10(3) - j * mp.log10(4))
            kept[j][i] = mp.nint(f * scale_a**i * scale_sigma**j / quantum) * quantum
    return filled([f for column in kept for f in column])


def filled(row):
    """A row with zeros at its end that make it a number of whole registers."""
    return row + [mpf(0)] * (-len(row) % REGISTER)


def table_w(sigma):
    """Table coordinate w of sigma."""
    root = mp.sqrt(2)
    return (3 + 2 * root) * (sigma + 1 - root) / (sigma + 1 + root)


def cells_module(halves):
    """Text of module piezo_viscous_cells."""
    pieces = [
        cell_rows(halves, side, octave, piece)
        for side in (1, -1)
        for octave in range(CELL_OCTAVES)
        for piece in range(CELL_OCTAVE_PIECES)
    ]
    text = [
        "!> Generated cells of the load of the exact piezo-viscous film, for its Taylor series. Do not edit.",
        f"!> Made by: {COMMAND}",
        "!>",
        "!> From each 2 + |A| = 2**n on, octave_pieces of equal length up to the next: first those of",
        "!> A >= 0, from 0 on, then those of A < 0, from -0 on. Each has sigma_cells of equal length from",
        "!> sigma = 0 to 1.",
        "module piezo_viscous_cells",
        "   use kinds, only: dp",
        "   implicit none (type, external)",
        "   private",
        "",
        "   !> Highest power of A, of max p* and of a cell, where it is that of A and sigma together.",
        f"   integer, parameter, public :: cell_degree = {CELL_DEGREE}",
        "   !> Numbers of a cell, and of a piece; those beyond the coefficients are zero.",
        f"   integer, parameter, public :: cell_size = {len(pieces[0][1])}, piece_size = {len(pieces[0][0])}",
        "   !> Pieces in an octave of 2 + |A|, those of one sign of A, and cells of a piece.",
        f"   integer, parameter, public :: octave_pieces = {CELL_OCTAVE_PIECES}",
        f"   integer, parameter, public :: side_pieces = {CELL_OCTAVE_PIECES * CELL_OCTAVES}",
        f"   integer, parameter, public :: sigma_cells = {SIGMA_CELLS}",
    ]
    names = []
    for number, piece in enumerate(pieces, 1):
        names.append(f"cells_{number}")
        text += piece_array(names[-1], piece[1:])
    text += piece_array("peaks", [piece[0] for piece in pieces])
    body = ", &\n      ".join(", ".join(names[i : i + 9]) for i in range(0, len(names), 9))
    text += [
        "",
        "   !> Centre of a piece of A, one over its unit, max p* in powers of (A - centre)/unit; piece.",
        "   real(dp), parameter, public :: peak_pieces(piece_size, 0:2*side_pieces - 1) = &",
        "      reshape(peaks, [piece_size, 2*side_pieces])",
        "",
        "   !> Psi in powers of (A - centre)/unit, for each power of sigma - centre; cell; piece.",
        "   real(dp), parameter, public :: cells(cell_size, 0:sigma_cells - 1, 0:2*side_pieces - 1) = &",
        "      reshape([ &",
        f"      {body}], &",
        "      [cell_size, sigma_cells, 2*side_pieces])",
    ]
    return "\n".join([*text, "", "end module piezo_viscous_cells", ""])
