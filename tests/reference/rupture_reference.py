"""Prints tests/unit/rupture_reference.f90: integrals, rupture and peak pressure of the Reynolds film.

Run as `python tests/reference/rupture_reference.py > tests/unit/rupture_reference.f90`.
"""

from exact_film import film
from mpmath import mp, mpf

DIGITS = 30
TANGENTS = [-1e8, -1e4, -300.0, -20.0, -4.0, -1.5, -1.0, -0.971, -0.969, -0.5, 0.0, 0.25, 1.0, 7.0, 1e3, 1e8]
MANTISSAS = ["1.0", "1.6", "2.5", "4.0", "6.3"]


def squeeze_groups() -> list[str]:
    """Every A of the table: both signs, five to a decade from 0.01 to 1e4, and zero."""
    sizes = [f"{m}e{e}" for e in range(-2, 4) for m in MANTISSAS] + ["1.0e4"]
    return [f"-{s}" for s in reversed(sizes)] + ["0.0"] + sizes


def integrals(tangent: float) -> tuple[mpf, mpf]:
    """J and K by quadrature of their definitions over t, dx = dt/(1 + t^2)."""
    with mp.workdps(2 * DIGITS):
        cuts = [-mp.inf, *(c for c in (-1e6, -100, -1, 1, 100) if c < tangent), mpf(tangent)]
        j = mp.quad(lambda t: t * t / (1 + t * t) ** 3, cuts)
        k = mp.quad(lambda t: 1 / (1 + t * t) ** 3, cuts)
        return j, k


def real(value: mpf) -> str:
    """Fortran literal of the nearest double."""
    return f"{float(value)!r}_dp".replace("e+", "e")


def table(name: str, comment: list[str], rows: list[list[str]]) -> list[str]:
    """Array constructor with one row of numbers to a line of code."""
    width = len(rows[0])
    lines = [f"   !> {line}" for line in comment]
    lines.append(f"   real(dp), parameter, public :: {name}({width}, {len(rows)}) = reshape([real(dp) :: &")
    for row in rows:
        half = (width + 1) // 2
        lines.append(f"      {', '.join(row[:half])}, &")
        last = ", &" if row is not rows[-1] else f"], [{width}, {len(rows)}])"
        lines.append(f"      {', '.join(row[half:])}{last}")
    return lines


def main() -> None:
    """Print the module."""
    integral_rows = [[f"{t!r}_dp", *(real(v) for v in integrals(t))] for t in TANGENTS]
    rupture_rows = []
    for text in squeeze_groups():
        exact = film(mpf(float(text)))
        with mp.workdps(DIGITS):
            values = (exact.tangent, exact.tangent_slope, 1 / exact.peak)
        rupture_rows.append([f"{text}_dp", *(real(value) for value in values)])
    print("!> Reference values of the Reynolds film, from integrals and roots in arbitrary precision;")
    print("!> written by tests/reference/rupture_reference.py.")
    print("module rupture_reference")
    print("   use kinds, only: dp")
    print("   implicit none (type, external)")
    print("   private\n")
    comment = ["t, J(t) and K(t), the integrals of sin^2 cos^2 and cos^4 from -pi/2 to atan t."]
    print("\n".join(table("integral_table", comment, integral_rows)) + "\n")
    comment = ["Squeeze group A, rupture tangent t_e, its slope dt_e/dA, and B_crit = 1/max p*."]
    print("\n".join(table("rupture_table", comment, rupture_rows)))
    print("\nend module rupture_reference")


if __name__ == "__main__":
    main()
