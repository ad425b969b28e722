"""Teeth that lose energy: an independent solver, closed forms of a collision, rows, sweeps and refusals."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from outcomes import summary_of
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq
from test_two_flanks import R1

import rattle

RADIUS, LENGTH = 0.0127, 0.01


@dataclass(frozen=True)
class Scene:
    """A tooth on one flank or between two, with films that pull (35) or rupture by Reynolds' condition."""

    ruptures: bool
    flanks: int
    viscosity: float
    speed: float
    mass: float
    stiffness: float
    damping_ratio: float
    steady: float
    amplitude: float
    frequency: float
    film: float
    backlash: float
    velocity: float = 0.0
    periods: int = 2
    samples: int = 256
    accuracy: float = 1e-10

    def text(self) -> str:
        model = "'reynolds'" if self.ruptures else "'published', rupture = 'half-pi'"
        backlash = f", backlash = {self.backlash}" if self.flanks == 2 else ""
        return f"""
&contact radius = {RADIUS}, length = {LENGTH}{backlash}
   stiffness = {self.stiffness}, damping_ratio = {self.damping_ratio} /
&lubricant viscosity = {self.viscosity}, pressure_viscosity = 2.0e-8 /
&kinematics entrainment_speed = {self.speed} /
&load mass = {self.mass}, steady_force = {self.steady}, gravity = 0.0
   force_amplitude = {self.amplitude}, frequency = {self.frequency} /
&film law = 'iso-viscous', model = {model}, initial_film = {self.film}, initial_velocity = {self.velocity} /
&solver until = 'periods', periods = {self.periods}
   samples_per_period = {self.samples}, accuracy = {self.accuracy} /
&spectrum periods = 1, verify = .false. /
&output columns = 'time', 'film_thickness', 'squeeze_velocity', 'film_load', 'gear_position' /
"""


@cache
def reynolds_integral() -> CubicSpline:
    """Logarithm of the integral of -t dp/dt of a film that ruptures, over sinh^-1 of its squeeze group A.

    dp/dt = (t^2 - e^2 + A (t - e))/(1 + t^2)^3 from -infinity to the rupture e, where p is 0 again.
    """
    places, weights = np.polynomial.legendre.leggauss(80)

    def integral(angle: float, group: float, power: int) -> float:
        half = 0.5 * (angle + 0.5 * np.pi)
        x, end = half * (places + 1.0) - 0.5 * np.pi, np.tan(angle)
        t = np.tan(x)
        return half * float(np.sum(weights * np.cos(x) ** 4 * (t - end) * (t + end + group) * (-t) ** power))

    loads, span = [], np.linspace(-14.0, 14.0, 1401)
    for group in np.sinh(span):
        # The pressure is largest at -A - e, ahead of the rupture.
        first, last = np.arctan(-0.5 * group) + 1e-13, 0.5 * np.pi - 1e-7
        loads.append(integral(brentq(integral, first, last, args=(group, 0), xtol=1e-15), group, 1))
    return CubicSpline(span, np.log(loads))


def film_load(scene: Scene, film: float, velocity: float) -> float:
    """W(h, h') [N]."""
    if not scene.ruptures:
        rolling = 2.8 * LENGTH * scene.speed * scene.viscosity * RADIUS
        resisting = 3.0 * np.pi * LENGTH * scene.viscosity * np.sqrt(0.5 * RADIUS) * RADIUS
        return rolling / film - resisting * velocity / film**1.5
    group = velocity * np.sqrt(2.0 * RADIUS / film) / scene.speed
    return (
        24.0
        * scene.viscosity
        * scene.speed
        * RADIUS
        * LENGTH
        / film
        * np.exp(reynolds_integral()(np.arcsinh(group)))
    )


def squeeze_velocity(scene: Scene, film: float, force: float, damping: float) -> float:
    """h' with W(h, h') - c h' = F, where c is the damping of the tooth and W falls with h'."""
    if not scene.ruptures:
        still = film_load(scene, film, 0.0)
        return (still - force) / (still - film_load(scene, film, 1.0) + damping)
    unit = scene.speed * np.sqrt(0.5 * film / RADIUS)

    def misses(place: float) -> float:
        velocity = unit * np.sinh(place)
        return film_load(scene, film, velocity) - damping * velocity - force

    return unit * np.sinh(brentq(misses, -14.0, 14.0, xtol=1e-14, rtol=1e-14))


def by_radau(scene: Scene, times: np.ndarray) -> dict[str, np.ndarray]:
    """The motion by scipy: position z, velocity z' and deflection D of each flank, scaled by the film."""
    stiffness = scene.stiffness
    damping = 2.0 * scene.damping_ratio * np.sqrt(stiffness * scene.mass)
    unit, pace = scene.film, 2.0 * np.pi * scene.frequency

    def flanks(state: np.ndarray) -> list[tuple[float, float, float]]:
        """Film, its velocity and the load of each flank."""
        found = []
        for flank, deflection in enumerate(state[2:] * unit):
            sign = 1.0 - 2.0 * flank
            film = (scene.backlash if flank else 0.0) + sign * state[0] * unit + deflection
            held = stiffness * deflection - damping * sign * state[1] * unit * pace
            squeeze = squeeze_velocity(scene, film, held, damping)
            found.append((film, squeeze, held + damping * squeeze))
        return found

    def rates(time: float, state: np.ndarray) -> list[float]:
        found = flanks(state)
        force = scene.steady + scene.amplitude * np.cos(pace * time)
        net = found[0][2] - (found[1][2] if len(found) > 1 else 0.0) - force
        deflections = [
            squeeze - sign * state[1] * unit * pace
            for (_, squeeze, _), sign in zip(found, (1.0, -1.0), strict=False)
        ]
        return [state[1] * pace, net / scene.mass / (unit * pace), *(rate / unit for rate in deflections)]

    # At the start each film carries its tooth at the velocity of the gear.
    deflections = [film_load(scene, scene.film, scene.velocity) / stiffness]
    if scene.flanks == 2:
        room = scene.backlash - scene.film + deflections[0]

        def misses(deflection: float) -> float:
            return film_load(scene, room + deflection, -scene.velocity) - stiffness * deflection

        deflections.append(brentq(misses, 0.0, scene.backlash, xtol=1e-24))
    start = [
        (scene.film - deflections[0]) / unit,
        scene.velocity / (unit * pace),
        *(d / unit for d in deflections),
    ]
    found = solve_ivp(rates, (0.0, times[-1]), start, "Radau", times, rtol=1e-10, atol=1e-12)
    assert found.success
    loads = np.array([flanks(state)[0] for state in found.y.T])
    return {
        "film_thickness": loads[:, 0],
        "film_load": loads[:, 2],
        "squeeze_velocity": found.y[1] * unit * pace,
        "gear_position": found.y[0] * unit,
    }


def random_scene(number: int) -> Scene:
    chance = np.random.default_rng(number)
    stiffness, mass = 10.0 ** chance.uniform(6.5, 8.5), 10.0 ** chance.uniform(-1.0, 0.5)
    steady = 10.0 ** chance.uniform(0.5, 2.0)
    film = 10.0 ** chance.uniform(-5.5, -4.7)
    return Scene(
        ruptures=number % 2 == 0,
        flanks=1 + number // 2 % 2,
        viscosity=10.0 ** chance.uniform(-1.7, -0.5),
        speed=chance.uniform(0.5, 3.0),
        mass=mass,
        stiffness=stiffness,
        damping_ratio=10.0 ** chance.uniform(-3.0, -0.3),
        steady=steady,
        amplitude=steady * chance.uniform(0.5, 2.0),
        frequency=10.0 ** chance.uniform(1.3, 2.7),
        film=film,
        backlash=film * chance.uniform(3.0, 10.0),
    )


@pytest.mark.parametrize(
    "number", [pytest.param(i, marks=pytest.mark.long if i > 5 else ()) for i in range(30)]
)
def test_motions_are_those_of_an_independent_solver(number: int, run, tmp_path: Path) -> None:
    scene = random_scene(number)
    (tmp_path / "tooth.nml").write_text(scene.text())
    ended = run("tooth.nml", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    result = rattle.read(tmp_path / "results" / "tooth.rattle")
    expected = by_radau(scene, np.array(result["time"]))
    for name, values in expected.items():
        found = np.array(result[name])
        assert np.max(np.abs(found - values)) < 1e-6 * np.max(np.abs(values)), name


# A tooth that is hit once, in a period of which nothing else happens.
HIT = Scene(
    ruptures=True,
    flanks=1,
    viscosity=1e-3,
    speed=1.0,
    mass=1.0,
    stiffness=1e8,
    damping_ratio=0.05,
    steady=1.0,
    amplitude=0.0,
    frequency=1000.0,
    film=1e-5,
    backlash=0.0,
    velocity=-0.1,
    periods=1,
    samples=4096,
)


@pytest.mark.parametrize("damping_ratio", [0.01, 0.05, 0.3])
def test_a_collision_without_film_is_that_of_a_spring_and_a_damper(
    damping_ratio: float, run, tmp_path: Path
) -> None:
    """The film gives way where the tooth would pull: it ends where its load does, before D is 0 again.

    A film of this viscosity takes 0.5 % of the velocity away of a tooth without damping, a smaller one less.
    """
    (tmp_path / "hit.nml").write_text(replace(HIT, damping_ratio=damping_ratio, viscosity=1e-4).text())
    assert run("hit.nml", cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "results" / "hit.summary.nml")
    kept = np.exp(-damping_ratio * (np.pi - 2.0 * np.arcsin(damping_ratio)) / np.sqrt(1.0 - damping_ratio**2))
    assert reported["velocity_maximum"] / 0.1 == pytest.approx(kept, abs=1e-3)


@pytest.mark.parametrize("damping_ratio", [0.001, 0.05, 0.3])
def test_a_tooth_that_its_film_holds_swings_by_the_closed_form(
    damping_ratio: float, run, tmp_path: Path
) -> None:
    """A film that never lets go: exp(-pi zeta/sqrt(1 - zeta^2)) from one pass of D = 0 to the next."""
    held = replace(
        HIT,
        ruptures=False,
        viscosity=1e7,
        speed=1e-9,
        steady=1e-6,
        damping_ratio=damping_ratio,
        velocity=-1e-10,
    )
    (tmp_path / "held.nml").write_text(held.text())
    assert run("held.nml", cwd=tmp_path).returncode == 0
    result = rattle.read(tmp_path / "results" / "held.rattle")
    deflection, velocity = (
        CubicSpline(result["time"], np.array(result["film_thickness"]) - np.array(result["gear_position"])),
        CubicSpline(result["time"], result["squeeze_velocity"]),
    )
    speeds = np.abs(velocity(deflection.roots(extrapolate=False)))
    assert len(speeds) > 1
    kept = np.exp(-np.pi * damping_ratio / np.sqrt(1.0 - damping_ratio**2))
    assert speeds[1:] / speeds[:-1] == pytest.approx(kept, rel=1e-4)


# Case R1 of two flanks on teeth that are damped, and what is compared.
PAIR = (
    R1.replace("1.0e-4 /", "1.0e-4, stiffness = 5.0e7, damping_ratio = 0.05 /").replace(
        "periods = 40, samples_per_period = 2048",
        "until = 'steady', periods = 200, samples_per_period = 4096",
    )
    + "&output columns = 'time', 'film_thickness', 'film_load', 'coast_film', 'coast_load',\n"
    "'gear_position' /\n"
)
# Films that pull or rupture, oil that thickens, and flanks that bend and flatten beside the damped tooth.
LAWS = {
    "iso": (),
    "half-pi": ("film.model=published", "film.rupture=half-pi"),
    "piezo": ("film.law=piezo-viscous",),
    "closure": ("film.law=elastohydrodynamic", "film.model=closure"),
    "flattening": (
        "film.law=elastohydrodynamic",
        "film.model=closure",
        "contact.flattening_included=.false.",
    ),
}
REPORTED = (
    "film_minimum",
    "acceleration_maximum",
    "film_force_rms",
    "film_dissipated_power",
    "tooth_dissipated_power",
)


def set_all(settings: tuple[str, ...]) -> list[str]:
    return [word for setting in settings for word in ("--set", setting)]


@pytest.mark.parametrize("law", LAWS)
def test_the_energy_balance_closes_and_is_distinct(law: str, run, tmp_path: Path) -> None:
    """What films and teeth lose is all that is lost; teeth lose the work that their loads do on them."""
    (tmp_path / "pair.nml").write_text(PAIR)
    assert run("pair.nml", *set_all(LAWS[law]), cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "results" / "pair.summary.nml")
    assert reported["status"] == "steady" and reported["verification"] == "verified"
    assert reported["film_dissipated_power"] + reported["tooth_dissipated_power"] == pytest.approx(
        reported["dissipated_power"], rel=1e-14
    )
    if law not in ("iso", "half-pi"):
        assert 0.0 < reported["tooth_dissipated_power"] < reported["dissipated_power"]
        return
    result = rattle.read(tmp_path / "results" / "pair.rattle")
    time, film, load, coast, coast_load, gear = (
        np.array(result[name])
        for name in ("time", "film_thickness", "film_load", "coast_film", "coast_load", "gear_position")
    )
    # The motion repeats with its last period.
    last = time >= time[-1] - 1.0 / 26.7 - 1e-9
    time, film, load, coast, coast_load, gear = (
        values[last] for values in (time, film, load, coast, coast_load, gear)
    )
    work = 0.0
    for deflection, carried in ((film - gear, load), (coast - 1e-4 + gear, coast_load)):
        work += CubicSpline(time, carried * CubicSpline(time, deflection)(time, 1)).integrate(
            time[0], time[-1]
        )
    power = work / (time[-1] - time[0])
    assert reported["tooth_dissipated_power"] == pytest.approx(power, rel=1e-5)


@pytest.mark.parametrize("law", LAWS)
def test_rows_sweeps_and_single_scenes_agree(law: str, run, tmp_path: Path) -> None:
    ratios = (0.0, 0.02, 0.04)
    (tmp_path / "pair.nml").write_text(PAIR)
    for ratio in ratios:
        given = set_all((*LAWS[law], f"contact.damping_ratio={ratio}"))
        assert run("pair.nml", *given, "--output", f"single{ratio}", cwd=tmp_path).returncode == 0
    names = ", ".join(f"'{name}'" for name in REPORTED)
    scene = PAIR[: PAIR.index("&output")]
    (tmp_path / "rows.nml").write_text(
        f"&scene task = 'campaign' /{scene}&campaign vary = 'contact.damping_ratio', first = 0.0, "
        "last = 0.04, count = 3, "
        f"record = {names} /\n"
    )
    steady = "until = 'steady', "
    # From 5e7 N/m to 6e7 N/m, each motion from the one before.
    (tmp_path / "swept.nml").write_text(
        f"&scene task = 'sweep' /{scene.replace(steady, '')}"
        "&sweep key = 'stiffness', first = 5.0e7, last = 6.0e7, count = 2 /\n"
    )
    for name in ("rows", "swept"):
        ended = run(f"{name}.nml", *set_all(LAWS[law]), cwd=tmp_path)
        assert ended.returncode == 0, ended.stderr
    rows = rattle.read(tmp_path / "results" / "rows.rattle")
    for place, ratio in enumerate(ratios):
        reported = summary_of(tmp_path / f"single{ratio}" / "pair.summary.nml")
        for name in REPORTED:
            assert np.array(rows[name])[place] == pytest.approx(
                reported.get(name, np.nan), rel=1e-7, nan_ok=True
            ), name
    swept = rattle.read(tmp_path / "results" / "swept.rattle")
    given = set_all((*LAWS[law], "contact.stiffness=6e7"))
    assert run("pair.nml", *given, "--output", "last", cwd=tmp_path).returncode == 0
    reported = summary_of(tmp_path / "last" / "pair.summary.nml")
    for name in ("film_minimum", "acceleration_maximum", "film_force_rms"):
        assert np.array(swept[name])[np.argmax(swept["stiffness"])] == pytest.approx(
            reported[name], rel=1e-7
        ), name


def test_pairs_from_no_damping_on_are_those_alone(run, repository: Path, tmp_path: Path) -> None:
    """Rows of both kinds stand side by side and hand their motions on; states of damped teeth are longer."""
    box = repository / "input" / "gearbox.nml"
    vary = {"vary": "'gear.tooth_damping_ratio'", "first": "0.0", "last": "0.1", "count": "5"}
    record = "campaign.record='verdict','film_force_rms','acceleration_rms'"
    given = set_all(
        ("scene.task='campaign'", *(f"campaign.{key}={value}" for key, value in vary.items()), record)
    )
    ended = run(box, *given, "--output", "rows", cwd=tmp_path)
    assert ended.returncode == 0, ended.stderr
    rows = rattle.read_campaign(tmp_path / "rows" / "gearbox.rattle")
    for ratio in (0.0, 0.1):
        alone = set_all((f"gear.tooth_damping_ratio={ratio}", "solver.starts=1"))
        assert run(box, *alone, "--output", f"alone{ratio}", cwd=tmp_path).returncode == 0
        for gear, pair in zip(rows.gears, rows.pairs, strict=True):
            reported = summary_of(tmp_path / f"alone{ratio}" / f"gearbox.{gear}.summary.nml")
            (place,) = np.flatnonzero(np.abs(np.array(pair["gear.tooth_damping_ratio"]) - ratio) < 1e-12)
            for name in ("film_force_rms", "acceleration_rms"):
                assert pair[name][place] == pytest.approx(reported[name], rel=1e-6), (gear, ratio, name)


def test_a_small_damping_is_near_none(run, tmp_path: Path) -> None:
    """The load of a damped tooth is no state of its own, so that no damping is too small to be followed."""
    (tmp_path / "pair.nml").write_text(PAIR)
    for ratio in (0.0, 1e-12, 1e-6):
        given = set_all((f"contact.damping_ratio={ratio}",))
        assert run("pair.nml", *given, "--output", f"of{ratio}", cwd=tmp_path).returncode == 0
    none, least, small = (
        summary_of(tmp_path / f"of{ratio}" / "pair.summary.nml") for ratio in (0.0, 1e-12, 1e-6)
    )
    for name in REPORTED[:3]:
        assert least[name] == pytest.approx(none[name], rel=1e-8), name
        assert small[name] == pytest.approx(none[name], rel=1e-6), name
    assert small["tooth_dissipated_power"] / least["tooth_dissipated_power"] == pytest.approx(1e6, rel=1e-3)


def test_a_resumed_run_is_the_whole_one(run, tmp_path: Path) -> None:
    for periods in (8, 30):
        (tmp_path / "pair.nml").write_text(
            PAIR.replace("until = 'steady', periods = 200", f"periods = {periods}")
        )
        assert run("pair.nml", "--resume" if periods > 8 else "--quiet", cwd=tmp_path).returncode == 0
    assert run("pair.nml", "--output", "whole", cwd=tmp_path).returncode == 0
    resumed, whole = (rattle.read(tmp_path / place / "pair.rattle") for place in ("results", "whole"))
    for name in ("film_thickness", "coast_load", "gear_position"):
        assert np.array_equal(np.array(resumed[name]), np.array(whole[name]))
