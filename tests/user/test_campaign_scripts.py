"""campaign.py: job scripts, state, export, single scenes again."""

from __future__ import annotations

import csv
import os
import stat
import subprocess
from pathlib import Path

import numpy as np
import pytest
import xarray
from campaign_writer import FORCE, FORCES, SPEED, SPEEDS, Key, grid, sample
from pyarrow import parquet
from script_calls import call_script

import rattle as package
from rattle import job_script, rerun
from rattle.namelist import parse


def call(directory: Path, *arguments: object, **environment: str) -> subprocess.CompletedProcess[str]:
    return call_script("campaign.py", *arguments, cwd=directory, **environment)


@pytest.fixture
def made():
    return grid(FORCES, SPEEDS, failures=True)


@pytest.fixture
def whole(made, tmp_path):
    return made.write(tmp_path / "map.rattle")


# --- job scripts


@pytest.fixture
def campaign_input(made, tmp_path) -> Path:
    path = tmp_path / "map.nml"
    path.write_text(made.input_text())
    return path


def script_text(directory: Path, *arguments: object) -> str:
    done = call(directory, "slurm", "map.nml", "--program", "/opt/rattle", *arguments)
    assert done.returncode == 0, done.stderr
    text = Path(directory, done.stdout.strip()).read_text()
    checked = subprocess.run(["bash", "-n"], input=text, text=True, capture_output=True, check=False)
    assert checked.returncode == 0, checked.stderr
    return text


def test_array_job(campaign_input, tmp_path):
    text = script_text(
        tmp_path, "--array", 8, "--time", "02:30:00", "--partition", "long", "--signal-seconds", 300
    )
    lines = text.splitlines()
    assert lines[0] == "#!/bin/bash"
    for directive in (
        "--job-name=map",
        "--array=1-8",
        "--ntasks=1",
        "--cpus-per-task=1",
        "--signal=B:USR1@300",
        "--requeue",
        "--open-mode=append",
        "--time=02:30:00",
        "--partition=long",
        f"--chdir={tmp_path}",
        "--output=%x-%A-%a.log",
    ):
        assert f"#SBATCH {directive}" in lines
    assert (
        '/opt/rattle --resume --threads "$OMP_NUM_THREADS" --set campaign.part="$SLURM_ARRAY_TASK_ID" '
        "--set campaign.parts=8 map.nml &" in lines
    )
    assert 'exec scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID"' in text


# Each would be split, ended, expanded or run if it stood unquoted in a shell.
ODD_NAMES = ("two words", "it's $HOME", "a;b&c|d", "$(touch ran)", "`touch ran`", "*", "#1", "-dash")


@pytest.mark.parametrize("name", ODD_NAMES)
@pytest.mark.parametrize("ranks", [False, True], ids=["array", "ranks"])
def test_a_job_script_hands_every_path_on_as_it_is(name, ranks, made, tmp_path):
    """The script is run, with stand-ins for rattle and srun that write down what they are called with."""
    place = tmp_path / f"at {name}"
    program = place / name / "rattle"
    program.parent.mkdir(parents=True)
    program.write_text('#!/bin/bash\nprintf "%s\\n" "$0" "$@" > "$REPORTED"\n')
    launcher = tmp_path / "bin" / "srun"
    launcher.parent.mkdir()
    launcher.write_text('#!/bin/bash\nshift\nexec "$@"\n')
    for stand_in in (program, launcher):
        stand_in.chmod(0o755)
    (place / f"{name}.nml").write_text(made.input_text().replace("&scene\n", "&scene\n name = 'map'\n"))
    division = ["--ranks", 2, "--launcher", "srun --mpi=pmix"] if ranks else ["--array", 2]
    # After -- an input may begin with a dash.
    done = call(place, "slurm", *division, "--program", program, f"--output=out {name}", "--", f"{name}.nml")
    assert done.returncode == 0, done.stderr
    script = place / done.stdout.removesuffix("\n")
    reported = tmp_path / "reported"
    environment = {
        **os.environ,
        "PATH": f"{launcher.parent}:{os.environ['PATH']}",
        "REPORTED": str(reported),
        "SLURM_ARRAY_TASK_ID": "2",
    }
    ended = subprocess.run(
        ["bash", str(script.resolve())],
        cwd=place,
        env=environment,
        capture_output=True,
        check=False,
        timeout=600.0,
    )
    assert ended.returncode == 0, ended.stderr
    called = reported.read_text().splitlines()
    assert called[0] == str(program)
    assert called[called.index("--output") + 1] == f"out {name}"
    assert called[-1] in (f"{name}.nml", f"./{name}.nml") and not called[-1].startswith("-")
    assert ("campaign.part=2" in called) is not ranks
    assert not list(tmp_path.rglob("ran"))
    directives = [line for line in script.read_text().splitlines() if line.startswith("#SBATCH")]
    assert f'#SBATCH --chdir="{place}"' in directives


def test_account_memory_and_modules(campaign_input, tmp_path):
    lines = script_text(
        tmp_path, "--account", "nvh-7", "--memory", "500M", "--module", "gcc/12", "--module", "openmpi"
    ).splitlines()
    assert "#SBATCH --account=nvh-7" in lines and "#SBATCH --mem-per-cpu=500M" in lines
    last_directive = max(i for i, line in enumerate(lines) if line.startswith("#SBATCH"))
    loads = [lines.index(f"module load {name} || exit 1") for name in ("gcc/12", "openmpi")]
    start = next(i for i, line in enumerate(lines) if line.startswith("/opt/rattle"))
    assert last_directive < loads[0] < loads[1] < start


def test_absurd_array_is_refused(campaign_input, tmp_path):
    command = ("campaign.py", "slurm", "map.nml", "--program", "/opt/rattle", "--array")
    refused = call_script(*command, 10_000_000, cwd=tmp_path)
    assert refused.returncode == 2 and "10000000 tasks are more than any cluster takes" in refused.stderr
    assert not (tmp_path / "map.slurm").exists()
    assert call_script(*command, 100_000, cwd=tmp_path).returncode == 0


def test_mpi_job(campaign_input, tmp_path):
    text = script_text(
        tmp_path, "--ranks", 64, "--threads", 2, "--output", "out", "--launcher", "srun --mpi=pmix"
    )
    assert "#SBATCH --ntasks=64" in text and "#SBATCH --cpus-per-task=2" in text
    assert "--array" not in text
    assert 'srun --mpi=pmix /opt/rattle --resume --threads "$OMP_NUM_THREADS" --output out map.nml &' in text
    assert "#SBATCH --output=out/%x-%j.log" in text
    assert (tmp_path / "out" / "map.slurm").exists()


FAKE_PROGRAM = """#!/bin/bash
echo "$@" >> {log}
trap 'exit {code}' USR1
for i in $(seq 50); do sleep 0.1; done
"""


@pytest.mark.parametrize(("code", "requeued"), [(138, True), (0, False), (3, False)])
def test_warning_is_handed_on_and_only_an_interrupted_job_goes_back(campaign_input, tmp_path, code, requeued):
    log = tmp_path / "calls"
    for name, text in (
        ("rattle", FAKE_PROGRAM.format(log=log, code=code)),
        ("scontrol", f'#!/bin/sh\necho scontrol "$@" >> {log}\n'),
    ):
        (tmp_path / name).write_text(text)
        (tmp_path / name).chmod(stat.S_IRWXU)
    made = call(tmp_path, "slurm", "map.nml", "--array", 3, "--program", tmp_path / "rattle")
    job = subprocess.Popen(
        ["bash", made.stdout.strip()],
        cwd=tmp_path,
        env=os.environ
        | {"PATH": f"{tmp_path}:{os.environ['PATH']}", "SLURM_ARRAY_JOB_ID": "7", "SLURM_ARRAY_TASK_ID": "2"},
    )
    for _ in range(100):
        if log.exists():
            break
        with pytest.raises(subprocess.TimeoutExpired):
            job.wait(0.05)
    with pytest.raises(subprocess.TimeoutExpired):
        job.wait(0.3)  # the trap of the program has to be set
    job.send_signal(10)
    assert job.wait(600) == (0 if requeued else code)
    lines = log.read_text().splitlines()
    expected = "--resume --threads 1 --set campaign.part=2 --set campaign.parts=3 map.nml"
    assert lines == [expected, "scontrol requeue 7_2"][: 1 + requeued]


def test_job_script_without_warning_keeps_the_exit_code(campaign_input, tmp_path):
    (tmp_path / "rattle").write_text("#!/bin/sh\nexit 1\n")
    (tmp_path / "rattle").chmod(stat.S_IRWXU)
    done = call(tmp_path, "slurm", "map.nml", "--program", tmp_path / "rattle")
    assert subprocess.run(["bash", done.stdout.strip()], cwd=tmp_path, check=False).returncode == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["absent.nml"], "No such file or directory"),
        (["map.nml", "--array", "0"], "is not a positive whole number"),
        (["map.nml", "--array", "2", "--ranks", "2"], "not allowed with argument"),
        (["map.nml", "--time", "90 min"], "'90 min' is not a time such as 90 (minutes), 02:30:00"),
        (["map.nml", "--time", "3"], "leaves no time to compute: Slurm may warn 180 s before it"),
        (["map.nml", "--signal-seconds", "70000"], "Slurm warns at most 65535 s ahead"),
        (["map.nml", "--time", "00:02:00"], "leaves no time to compute: Slurm may warn 180 s before it"),
        (["map.nml", "--memory", "2 GB"], "'2 GB' is not an amount of memory such as 500M, 2G or 4096"),
        (["map.nml", "--account", "a b"], "'a b' is not a name that Slurm takes"),
        (["plain.nml"], "plain.nml has no group &campaign."),
    ],
)
def test_job_scripts_that_cannot_work_are_refused(campaign_input, tmp_path, arguments, words):
    (tmp_path / "plain.nml").write_text("&scene\n   name = 'a'\n/\n")
    done = call(tmp_path, "slurm", *arguments, "--program", "/opt/rattle")
    assert done.returncode == 2
    assert words in done.stderr
    assert "Traceback" not in done.stderr
    assert not list(tmp_path.glob("*.slurm"))


def test_an_older_script_is_kept(campaign_input, tmp_path):
    script_text(tmp_path)
    before = (tmp_path / "map.slurm").read_text()
    done = call(tmp_path, "slurm", "map.nml", "--array", 2, "--program", "/opt/rattle")
    assert done.returncode == 2
    assert (tmp_path / "map.slurm").read_text() == before
    assert "--array=1-2" in script_text(tmp_path, "--array", 2, "--overwrite")


@pytest.mark.parametrize(
    ("time", "seconds"),
    [
        ("00:00:59", 59),
        ("01:02:03", 3723),
        ("30:00:00", 108000),
        ("2-01:00:00", 176400),
        ("90", 5400),
        ("90:30", 5430),
        ("1:90:75", 9075),
        ("2-", 172800),
        ("2-01", 176400),
        ("2-01:30", 178200),
        ("0-0:0:45", 45),
        ("UNLIMITED", None),
        ("infinite", None),
        ("-1", None),
        ("0", None),
        ("00:00:00", None),
    ],
)
def test_time_limits_are_read_as_slurm_does(time, seconds):
    """As its time_str2secs does; no time at all is no limit."""
    assert job_script.seconds_of(time) == seconds


@pytest.mark.parametrize("time", ["", "90 ", "1:2:3:4", "1-2-3", "-5", ":30", "1-:30", "1h", "\u0661", "1.5"])
def test_what_slurm_does_not_take_is_no_time(time):
    with pytest.raises(ValueError):
        job_script.seconds_of(time)


def test_what_slurm_takes_stands_in_the_script_as_it_was_given(campaign_input, tmp_path):
    given = {"--partition": "long,short", "--account": "nvh/7#a", "--memory": "4096"}
    for time in ("90", "UNLIMITED"):
        options = [part for pair in {**given, "--time": time}.items() for part in pair]
        lines = script_text(tmp_path, *options, "--overwrite").splitlines()
        assert f"#SBATCH --time={time}" in lines and "#SBATCH --mem-per-cpu=4096" in lines
        assert "#SBATCH --partition=long,short" in lines and '#SBATCH --account="nvh/7#a"' in lines
    for memory in ("2g", "512MB", "1Tb", "0"):
        assert f"#SBATCH --mem-per-cpu={memory}" in script_text(tmp_path, "--memory", memory, "--overwrite")


# --- state


def test_status_of_a_finished_campaign(made, whole):
    done = call(whole.parent, "status", "map.rattle")
    assert (done.returncode, done.stderr) == (0, "")
    rows = {line[:20].strip(): line[20:].strip() for line in done.stdout.splitlines()}
    assert any(value == "finished" for value in rows.values())
    assert "5 of 5" in done.stdout
    assert "300 of 300 (100 %)" in done.stdout
    assert "status film_lost" in done.stdout
    verified, failed = made.column("verified"), int((made.column("status") > 1.0).sum())
    for words, count in (("not verified", int((verified == 0.0).sum())), ("failed", failed)):
        assert rows[words] == f"{count} ({100.0 * count / 300.0:.3g} %)"


def test_status_of_an_unfinished_one_shows_its_progress(made, tmp_path):
    made.write(tmp_path / "map.rattle", undone=[2, 4], closed=False)
    (tmp_path / "map.progress.nml").write_text("&progress\n   rate = 1234.5678\n   time_left = 12\n/\n")
    done = call(tmp_path, "status", "map.rattle")
    assert done.returncode == 0
    assert "not finished; rattle --resume goes on" in done.stdout
    assert "3 of 5" in done.stdout and "192 of 300 (64 %)" in done.stdout
    assert "progress: rate" in done.stdout and "1234.57" in done.stdout
    (tmp_path / "map.progress.nml").write_text("&progress\n   rate = 12")
    assert call(tmp_path, "status", "map.rattle").returncode == 0


def test_status_of_parts_goes_on_past_a_bad_one(made, tmp_path):
    made.write_parts(tmp_path, 2)
    done = call(tmp_path, "status", "map.part-1-of-2.rattle", "absent.rattle", "map.part-2-of-2.rattle")
    assert done.returncode == 2
    assert "1 of 2" in done.stdout and "2 of 2" in done.stdout
    assert "absent.rattle cannot be read" in done.stderr


# --- export


def test_csv_reads_back_exactly(made, whole):
    done = call(whole.parent, "export", "map.rattle", "--to", "csv")
    assert (done.returncode, done.stdout) == (0, "map.csv\n"), done.stderr
    with whole.with_suffix(".csv").open(newline="") as stream:
        head, *rows = csv.reader(stream)
    assert head[:3] == ["scene[-]", f"{FORCE}[N]", f"{SPEED}[m/s]"]
    assert head[-3:] == ["status_word", "rattle_class_word", "film_regime_word"]
    numbers = np.array([[float(cell) for cell in row[:-3]] for row in rows])
    np.testing.assert_array_equal(numbers, made.rows)
    assert {row[-3] for row in rows} == {"steady", "film_lost", "no_rigid_film"}


def test_parquet_holds_columns_units_and_input(made, whole):
    done = call(whole.parent, "export", "map.rattle", "--to", "parquet")
    assert done.returncode == 0, done.stderr
    table = parquet.read_table(whole.with_suffix(".parquet"))
    for name, _ in made.columns[1:]:
        np.testing.assert_array_equal(table[name].to_numpy(), made.column(name))
    assert table.schema.field("film_minimum").metadata == {b"unit": b"m"}
    assert b"&campaign" in table.schema.metadata[b"resolved_input"]
    assert "film_lost" in table["status_word"].unique().to_pylist()


def test_netcdf_holds_the_grid(made, whole):
    done = call(whole.parent, "export", "map.rattle", "--to", "netcdf", "--output", "grid.nc")
    assert (done.returncode, done.stdout) == (0, "grid.nc\n"), done.stderr
    with xarray.open_dataset(whole.parent / "grid.nc") as data:
        assert dict(data.sizes) == {FORCE: 20, SPEED: 15}
        expected = package.read_campaign(whole).dataset()
        np.testing.assert_array_equal(
            data["acceleration_maximum"].values, expected["acceleration_maximum"].values
        )
        assert data["film_minimum"].attrs["units"] == "m"
        assert data.attrs["source"] == "rattle 0.1.0"


@pytest.mark.parametrize("form", ["csv", "parquet", "netcdf"])
def test_unfinished_and_sampled_campaigns_are_exported_too(tmp_path, form):
    made = sample()
    made.write(tmp_path / "cloud.rattle", undone=[1], closed=False)
    done = call(tmp_path, "export", "cloud.rattle", "--to", form)
    assert done.returncode == 0, done.stderr
    output = tmp_path / {"csv": "cloud.csv", "parquet": "cloud.parquet", "netcdf": "cloud.nc"}[form]
    expected = np.delete(made.column("acceleration_maximum"), slice(64, 128))
    if form == "csv":
        with output.open(newline="") as stream:
            values = [float(row["acceleration_maximum[m/s2]"]) for row in csv.DictReader(stream)]
    elif form == "parquet":
        values = parquet.read_table(output)["acceleration_maximum"].to_numpy()
    else:
        with xarray.open_dataset(output) as data:
            values = data["acceleration_maximum"].values
    np.testing.assert_array_equal(values, expected)
    assert done.stderr == (
        "campaign.py: cloud.rattle is not finished; 236 of 300 scenes are done and used.\n"
    )
    again = call(tmp_path, "export", "cloud.rattle", "--to", form)
    assert again.returncode == 2
    assert "exists; --overwrite replaces it." in again.stderr


def test_a_missing_package_is_one_sentence(whole, tmp_path):
    (tmp_path / "hidden").mkdir()
    (tmp_path / "hidden" / "xarray.py").write_text("raise ImportError('No module named xarray')\n")
    done = call(tmp_path, "export", "map.rattle", "--to", "netcdf", PYTHONPATH=str(tmp_path / "hidden"))
    assert done.returncode == 2
    assert "A Python module cannot be loaded (No module named xarray)" in done.stderr
    assert "Traceback" not in done.stderr


# --- single scenes again


def test_worst_scenes_become_inputs(made, whole):
    done = call(whole.parent, "rerun", "map.rattle", "--worst", 4, "--by", "film_maximum")
    assert done.returncode == 0, done.stderr
    usable = np.where(made.column("status") == 1, made.column("film_maximum"), -1.0)
    scenes = np.argsort(-usable, kind="stable")[:4] + 1
    assert done.stdout.split() == [f"map_scenes/map_{scene:03d}.nml" for scene in scenes]
    groups = parse((whole.parent / done.stdout.split()[0]).read_text())
    assert "campaign" not in groups
    assert groups["scene"]["name"] == f"map_{scenes[0]:03d}"
    assert groups["scene"]["task"] == "motion"
    assert groups["output"]["series"] is True
    assert groups["load"]["force_amplitude"] == made.column(FORCE)[scenes[0] - 1]
    assert groups["kinematics"]["entrainment_speed"] == made.column(SPEED)[scenes[0] - 1]
    assert groups["load"]["mass"] == 3.0


def test_a_scene_that_failed_is_never_the_worst(made, whole):
    """What is known of it, its frequency, may be the largest; it has no motion to look at."""
    frequency = made.column("natural_frequency")
    frequency[np.argmax(made.column("status"))] = 1e6
    campaign = package.read_campaign(made.write(whole))
    worst = rerun.extreme_rows(campaign, "natural_frequency", 3)
    usable = np.where(made.column("status") == 1.0, frequency, -1.0)
    np.testing.assert_array_equal(worst, np.argsort(-usable, kind="stable")[:3])


def test_smallest_failed_and_named_scenes(made, whole):
    done = call(
        whole.parent,
        "rerun",
        "map.rattle",
        "--worst",
        1,
        "--by",
        "film_minimum",
        "--smallest",
        "--output",
        "s",
    )
    assert done.stdout == f"s/map_{np.nanargmin(made.column('film_minimum')) + 1:03d}.nml\n"
    failures = np.flatnonzero(made.column("status") > 1) + 1
    done = call(whole.parent, "rerun", "map.rattle", "--failed", 2, "--output", "f")
    assert done.stdout.split() == [f"f/map_{scene:03d}.nml" for scene in failures[:2]]
    done = call(whole.parent, "rerun", "map.rattle", "--scenes", "7,3", "--output", "n")
    assert done.stdout.split() == ["n/map_007.nml", "n/map_003.nml"]


def test_a_key_that_takes_whole_numbers_stays_whole(tmp_path):
    made = grid(FORCES, name="steps")
    made.columns[1] = ("solver.periods", "-")
    made.group = made.group.replace(FORCE, "solver.periods")
    made.write(tmp_path / "steps.rattle")
    done = call(tmp_path, "rerun", "steps.rattle", "--scenes", "1")
    assert "periods = 20\n" in (tmp_path / done.stdout.strip()).read_text()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--worst", "2", "--by", "film"], "has no column 'film'"),
        (["--scenes", "301"], "holds no scene 301 that is done."),
        (["--failed", "1", "--worst", "1"], "not allowed with argument"),
        ([], "one of the arguments --worst --failed --scenes is required"),
    ],
)
def test_scenes_that_are_not_there_are_refused(whole, arguments, words):
    done = call(whole.parent, "rerun", "map.rattle", *arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert not (whole.parent / "map_scenes").exists()


def test_the_program_takes_the_inputs(run, tmp_path):
    made = grid(Key(FORCE, 100.0, 205.7, 3), name="small")
    made.write(tmp_path / "small.rattle")
    inputs = call(tmp_path, "rerun", "small.rattle", "--worst", 3).stdout.split()
    done = run("--quiet", *inputs, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    result = package.read(tmp_path / "results" / "small_1.rattle")
    assert result.number("load", "force_amplitude") == 100.0
    assert result.closed
