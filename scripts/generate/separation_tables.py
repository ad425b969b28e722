"""Tables of the stiffness of the Reynolds film on fast separation, where its own terms cancel.

At a given velocity x = 1/A**2 goes with the film h. The load W goes with Psi/h, so with Psi/x = Y, which
tends to a constant as x -> 0: the load of a film that separates fast hardly depends on its thickness, and
the stiffness group is what remains,

    Psi + (A/2) dPsi/dA + (3/2) B dPsi/dB = -x**2 dY/dx   at constant B x**(-3/2).

Y is analytic in x, with its nearest singularity at x = -1/4 (A = +-2i), and in sigma = sqrt(1 - B/B_crit); so
is P = max p* x**(-3/2), and sigma moves with it: dsigma/dx = -(1 - sigma**2) (P'/P)/(2 sigma). On
0 <= x <= 1/A**2 of the first A, interpolation at Chebyshev points gains a factor of about 60 with each term.
The coordinate of sigma is that of module film_tables.
"""

from film_functions import COMMAND, Film, array_text, chebyshev_coefficients, chebyshev_nodes, powers
from film_tables import piezo_excess, sigma_nodes, tanh_sinh
from mpmath import mp, mpf

FIRST_GROUP = 8
NODES = (20, 28)
TERMS = (10, 16)


def powers_from_zero(values, terms):
    """Coefficients of ascending powers of u = (1 + node)/2, through values at chebyshev_nodes."""
    result = [mpf(0)] * terms
    for factor in reversed(powers(chebyshev_coefficients(values, terms))):
        # One step of Horner's scheme: the polynomial so far times 2 u - 1, plus the factor.
        shifted = [mpf(0), *(2 * c for c in result[:-1])]
        result = [s - c for s, c in zip(shifted, result, strict=True)]
        result[0] += factor
    return result


def separation_module():
    """Text of module separation_coefficients."""
    rule = tanh_sinh(mpf(1) / 32, 112)
    sigmas = sigma_nodes(NODES[1])
    last = 1 / mpf(FIRST_GROUP) ** 2
    loads, peaks, columns = [], [], []
    for node in chebyshev_nodes(NODES[0]):
        x = last * (1 + node) / 2
        film = Film(1 / mp.sqrt(x))
        excess = piezo_excess(film, sigmas, rule)
        loads.append(film.phi / x)
        peaks.append(mp.log(film.peak / x / mp.sqrt(x)))
        values = [loads[-1] * (1 + (1 - s) * e) for s, e in zip(sigmas, excess, strict=True)]
        columns.append(powers(chebyshev_coefficients(values, TERMS[1])))
    table = [powers_from_zero([column[j] for column in columns], TERMS[0]) for j in range(TERMS[1])]
    text = [
        "!> Generated tables of the Reynolds film on fast separation. Do not edit.",
        f"!> Made by: {COMMAND}",
        "!>",
        "!> Ascending powers of u = (first_group/A)**2, 0 <= u <= 1, where the film separates faster than",
        "!> first_group says. The script derives what they are for.",
        "module separation_coefficients",
        "   use kinds, only: dp",
        "   implicit none (type, external)",
        "   private",
        "",
        "   !> Least A of the tables [-].",
        f"   real(dp), parameter, public :: first_group = {FIRST_GROUP}.0_dp",
        "   !> Highest power of u, and of the coordinate w of module piezo_viscous_coefficients.",
        f"   integer, parameter, public :: separation_degree = {TERMS[0] - 1}",
        f"   integer, parameter, public :: separation_sigma_degree = {TERMS[1] - 1}",
    ]
    for name, meaning, values in (
        ("load", "Phi A**2", loads),
        ("log_peak", "ln(max p* A**3)", peaks),
    ):
        body = array_text(powers_from_zero(values, TERMS[0]))
        text += [
            "",
            f"   !> {meaning}",
            f"   real(dp), parameter, public :: separation_{name}(0:separation_degree) = [ &",
            f"      {body}]",
        ]
    body = array_text([v for row in table for v in row])
    text += [
        "",
        "   !> Psi A**2 in powers of u (first index) and of w (second index)",
        "   real(dp), parameter, public :: &",
        "      separation_piezo_load(0:separation_degree, 0:separation_sigma_degree) = reshape([ &",
        f"      {body}], &",
        "      [separation_degree + 1, separation_sigma_degree + 1])",
    ]
    return "\n".join([*text, "", "end module separation_coefficients", ""])
