"""Generate the coefficient tables of the exact (Swift-Stieber) film.

Write:  python scripts/generate/reynolds_film.py
Check:  python scripts/generate/reynolds_film.py --check

The check recomputes the modules and compares them byte for byte with the files in fsrc/film/coefficients.
"""

import argparse
import sys
from pathlib import Path

from film_functions import DIGITS
from film_tables import iso_module, piezo_module, piezo_table
from mpmath import mp
from separation_tables import separation_module
from series_tables import cells_module, pieces_module

ROOT = Path(__file__).resolve().parents[2]
TARGET = ROOT / "fsrc" / "film" / "coefficients"


def main() -> int:
    """Write the modules, or compare them with the files."""
    parser = argparse.ArgumentParser(description="Coefficient tables of the Reynolds film.")
    parser.add_argument("--check", action="store_true", help="compare with the files instead of writing them")
    arguments = parser.parse_args()
    mp.dps = DIGITS
    status = 0
    halves = piezo_table()
    for name, text in (
        ("iso_viscous_coefficients", iso_module()),
        ("piezo_viscous_coefficients", piezo_module(halves)),
        ("load_pieces", pieces_module()),
        ("separation_coefficients", separation_module()),
        ("piezo_viscous_cells", cells_module(halves)),
    ):
        path = TARGET / f"{name}.f90"
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
