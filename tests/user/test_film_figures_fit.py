"""The regression (32): its table and figure, and ranges that fit nothing."""

from __future__ import annotations

import pytest
from figure_files import stems
from kernel_module import kernels
from script_calls import call_script

from rattle.figures import film_fit


@pytest.mark.long
def test_the_fit_is_printed_and_drawn(tmp_path):
    done = call_script("plot.py", "film-fit", "--output", tmp_path / "figures", "--alpha-p", "0.3,1", "0,0.5")
    assert done.returncode == 0, done.stderr
    assert stems(tmp_path / "figures") == ["film_fit"]
    rows = done.stdout.splitlines()
    assert len(rows) == 2 + 3 * 2 + 1
    fit = kernels.fit_film_law(*kernels.sample_film_window((5e-5, 2e-4), (-5e-4, 5e-4), (0.3, 1.0)))
    assert f"{fit.law.load_exponent:.3f}" in rows[2] and f"{fit.law.squeeze_factor:.1f}" in rows[2]
    assert rows[-1].split()[-4:] == ["0.787", "0.7", "-0.4", "-281.2"]


@pytest.mark.long
def test_the_fit_in_markdown_over_other_ranges(tmp_path):
    ranges = ("--film-ratio", "6e-5,1e-4", "--squeeze-ratio=-4e-4,0", "--speed-group", "2e-7,2e-6")
    done = call_script(
        "plot.py", "film-fit", "--output", tmp_path, "--markdown", "--upper-end", "0.95", *ranges
    )
    assert done.returncode == 0, done.stderr
    assert all(line.startswith("| ") for line in done.stdout.splitlines())


def test_readings_move_the_factor_alone():
    ranges = film_fit.Ranges((5e-5, 2e-4), (-5e-4, 5e-4), None)
    fits = [film_fit.fit_window(ranges, reading, (0.5, 1.0)) for reading in film_fit.READINGS]
    for one in fits[1:]:
        assert one.fit.law[1:] == pytest.approx(fits[0].fit.law[1:], rel=1e-9)
        assert one.fit.error.rms == pytest.approx(fits[0].fit.error.rms, rel=1e-9)
    assert fits[1].printed.rms < fits[0].printed.rms


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--film-ratio", "1e-4,1e-4"), "A single h* determines no law"),
        (("--film-ratio", "2e-4,1e-4"), "is not a range LEAST,LARGEST"),
        (("--alpha-p=-1,2",), "a window needs 0 < h*"),
        (("--speed-group", "1,2"), "holds 0 films"),
        (("--upper-end", "1.5"), "is not a number above 0 and up to 1"),
    ],
)
def test_ranges_that_fit_nothing_are_explained(tmp_path, arguments, sentence):
    done = call_script("plot.py", "film-fit", "--output", tmp_path, *arguments)
    assert done.returncode == 2
    assert sentence in done.stderr and "Traceback" not in done.stderr
    assert not list(tmp_path.iterdir())
