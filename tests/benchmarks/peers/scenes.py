"""The scenes of the bench in the scaled form that all contenders integrate.

Scaled variables: y = h/h0, tau = f t (one excitation period is 1), v = dy/dtau. With the mean load Q + m g
carried by the steady film h0 (which fixes the contact length l), the equation of motion (1) is

    y'' = a (G(y, v) - 1 - q cos(2 pi tau)),    y(0) = 1,    y'(0) = 0,    0 <= tau <= 200,
    a = (Q + m g)/(m h0 f^2),    q = F0/(Q + m g),

and G, the film load divided by the mean load, is for the four films

    published iso-viscous (35)      G = (1 - c v/sqrt(y))/y,      c = 3 pi/(2.8 sqrt 2) sqrt(R h0) f/u
    published piezo-viscous (37)    G = y^(-7/2) exp(-c v),       c = 703 f h0/u
    Reynolds iso-viscous            G = Phi(A)/(y Phi(0)),        A = c v/sqrt(y),  c = 4 f sqrt(R h0/2)/u_r
    Reynolds piezo-viscous          G = Psi(A, B)/(y Psi(0, B0)), A as above,  B = B0 y^(-3/2),
                                    B0 = 6 sqrt(2 R) alpha u_r eta0 h0^(-3/2)

Phi and Psi are the exact load groups of the Swift-Stieber film: with J(x), K(x) the integrals of sin^2
cos^2 and cos^4 from -pi/2 and t = tan x,

    p*(x) = J - t_e^2 K - A (cos(x)^4/4 + t_e K),    p*(x_e) = 0,
    Phi = integral of p* dt,    Psi = (1/B) integral of -ln(1 - B p*) dt,    t from -infinity to t_e.

Scenes: R 0.0127 m, eta0 0.3 Pa s, m 3 kg, f 600 Hz, h0 0.89 um, Q 40 N, F0 = 0.1, 1 and 3 Q, alpha 2e-8
1/Pa. The published films put u = 1.9 m/s into the printed formulas; the Reynolds films take u_r = u1 + u2 =
1.9 m/s, with l from their own static balance. For the Reynolds piezo-viscous film alpha is lowered until
the largest alpha p of the run is 0.9: the numbers in REYNOLDS_ALPHA, found by `../reference/find_alpha.py`.

The six published scenes are also changed in four ways (CHANGES): a force of three orders, two flanks, teeth
that give, and all three. With w the load of a film over the mean load, b the backlash over h0, z the
position of the gear over h0 and e = (Q + m g)/(k h0) the compliance of a tooth,

    v' = a (w_1 - w_2 - 1 - sum_n q_n cos(2 pi n tau + phi_n)),
    rigid teeth    w_1 = G(y, v),  w_2 = G(b - y, -v),  y = z,
    elastic teeth    z' = v,  e w_1 = y_1 - z,  e w_2 = y_2 - (b - z),
                       y_1' = g(y_1, w_1),  y_2' = g(y_2, w_2),

where g is G solved for the velocity: sqrt(y) (1 - y w)/c for (35), -ln(w y^(7/2))/c for (37). With one
flank w_2 = 0. The motion starts at y_1 = 1, v = 0, the films at no velocity. k is twice the stiffness of the
steady film. At F0 = 3 Q the film of (37) lets the tooth go: w falls towards 0, g gets infinitely
steep, and explicit steps do not follow. That scene is a group of its own ("a film that ruptures").
The motion of (35) with elastic teeth at F0 = 3 Q is chaotic, no one knows it after 200 periods: it is
judged in the last ten of 20 periods, timed over 200, and a group of its own as well. With all three changes
the films of (35) and (37) are a group each.

The exact iso-viscous film stands between two rigid flanks too (bench_gearbox.py): w_2 = Phi(A_2)/((b - y)
Phi(0)), A_2 = -c v/sqrt(b - y), with the rupture angles of both flanks as states and a start at rest.

Error measure: largest |h/h_reference - 1| over the last 10 periods at 64 points a period, that is at
tau = 190 + k/64, k = 1 ... 640, against `../reference/film.csv`, and for the changed scenes against the
tightest solution of a peer.
"""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

RADIUS, VISCOSITY, MASS, FREQUENCY = 0.0127, 0.3, 3.0, 600.0
INITIAL_FILM, STATIC_FORCE, SPEED, GRAVITY = 0.89e-6, 40.0, 1.9, 9.80665
ALPHA = 2.0e-8
FORCE_FACTORS = (0.1, 1.0, 3.0)
REYNOLDS_ALPHA = {0.1: 1.055592e-8, 1.0: 4.820269e-9, 3.0: 5.906726e-10}

PERIODS, SAMPLED_PERIODS, POINTS_A_PERIOD = 200, 10, 64
SAMPLE_COUNT = SAMPLED_PERIODS * POINTS_A_PERIOD
SAMPLE_TIMES = (PERIODS - SAMPLED_PERIODS) + np.arange(1, SAMPLE_COUNT + 1) / POINTS_A_PERIOD

# Of the changed scenes: amplitudes over F0 of the orders 1, 2, 3 and their phases, backlash in steady films,
# stiffness of the teeth in stiffnesses of the steady film.
ORDER_SHARES, ORDER_PHASES = (1.0, 60.0 / 150.0, 25.0 / 150.0), (0.0, 0.7, -1.2)
BACKLASH, STIFFNESS = 5.0, 2.0
FILM_STIFFNESS = {"iso_viscous": 1.0, "piezo_viscous": 3.5}
CHANGES = {
    "three orders": ("orders",),
    "two flanks": ("flanks",),
    "elastic teeth": ("springs",),
    "all three": ("orders", "flanks", "springs"),
}
CHAOTIC_PERIODS = 20
EQUATION = {"iso_viscous": "(35)", "piezo_viscous": "(37)"}
LETS_GO = "a film that ruptures"

REFERENCE_FILE = Path(__file__).resolve().parent.parent / "reference" / "film.csv"

# Rupture of the steady film, tan x_e at A = 0, and the angle counted from -pi/2.
STEADY_TANGENT = 0.4751299200930563
STEADY_ANGLE = math.pi / 2 + math.atan(STEADY_TANGENT)


@dataclass(frozen=True)
class Scene:
    """One scene: SI data and the scaled numbers a, c, q, B0 and the steady load group."""

    name: str
    model: str
    law: str
    force_amplitude: float
    pressure_viscosity: float
    length: float
    acceleration_scale: float
    squeeze_scale: float
    force_ratio: float
    pressure_scale: float
    steady_load: float
    # Amplitudes over the mean load and phases of the orders above the first, whose amplitude is force_ratio;
    # backlash over h0 (0: one flank), compliance of a tooth as in the header (0: rigid).
    more_ratios: tuple[float, ...] = ()
    phases: tuple[float, ...] = ()
    backlash: float = 0.0
    compliance: float = 0.0
    group: str = ""
    periods: int = PERIODS

    @property
    def kind(self) -> tuple:
        """What the equations depend on: film, number of orders, two flanks, elastic teeth."""
        return self.film, 1 + len(self.more_ratios), self.backlash > 0.0, self.compliance > 0.0

    @property
    def sample_times(self) -> np.ndarray:
        """Times of the samples."""
        return SAMPLE_TIMES - PERIODS + self.periods

    @property
    def is_changed(self) -> bool:
        """Whether it is more than one cosine on one rigid flank."""
        return self.kind[1:] != (1, False, False)

    @property
    def film(self) -> str:
        """Film name: model and law."""
        return f"{self.model} {self.law}"

    @property
    def parameters(self) -> np.ndarray:
        """The scaled numbers in the order a, c, q, B0, steady load group."""
        return np.array(
            [
                self.acceleration_scale,
                self.squeeze_scale,
                self.force_ratio,
                self.pressure_scale,
                self.steady_load,
            ]
        )


def steady_load_group(pressure_scale: float) -> float:
    """Psi(0, B0), and Phi(0) for B0 = 0, by 200 Gauss points from -pi/2 to x_e (integrated by parts)."""
    nodes, weights = np.polynomial.legendre.leggauss(200)
    phi = 0.5 * STEADY_ANGLE * (nodes + 1.0)
    s, c = np.sin(phi), np.cos(phi)
    j = phi / 8 - np.sin(4 * phi) / 32
    k = 3 * phi / 8 - np.sin(2 * phi) / 4 + np.sin(4 * phi) / 32
    pressure = j - STEADY_TANGENT**2 * k
    rise = s * c * (c * c - (STEADY_TANGENT * s) ** 2)
    return float(0.5 * STEADY_ANGLE * np.sum(weights * rise / (1.0 - pressure_scale * pressure)))


def make_scene(model: str, law: str, factor: float, alpha: float | None = None) -> Scene:
    """Scene of a model (published, reynolds), law (iso_viscous, piezo_viscous) and F0/Q.

    Parameters
    ----------
    alpha : float, optional
        Barus coefficient [1/Pa] instead of the recorded one.
    """
    load = STATIC_FORCE + MASS * GRAVITY
    force = factor * STATIC_FORCE
    piezo = law == "piezo_viscous"
    if alpha is None:
        alpha = REYNOLDS_ALPHA[factor] if model == "reynolds" and piezo else ALPHA
    scale, steady = 0.0, 1.0
    if model == "published":
        if piezo:
            squeeze = 703.0 * FREQUENCY * INITIAL_FILM / SPEED
            load_of_length = 6.6 * (SPEED * VISCOSITY) ** 2.75 * (RADIUS * alpha) ** 1.75 * INITIAL_FILM**-3.5
        else:
            rate = math.sqrt(RADIUS * INITIAL_FILM) * FREQUENCY / SPEED
            squeeze = 3 * math.pi / (2.8 * math.sqrt(2)) * rate
            load_of_length = 2.8 * SPEED * VISCOSITY * RADIUS / INITIAL_FILM
    else:
        squeeze = 4 * FREQUENCY * math.sqrt(RADIUS * INITIAL_FILM / 2) / SPEED
        if piezo:
            scale = 6 * math.sqrt(2 * RADIUS) * alpha * SPEED * VISCOSITY * INITIAL_FILM**-1.5
        steady = steady_load_group(scale)
        load_of_length = 12 * SPEED * VISCOSITY * RADIUS / INITIAL_FILM * steady
    return Scene(
        name=f"{model}-{law.removesuffix('_viscous')}-{factor:g}",
        model=model,
        law=law,
        force_amplitude=force,
        pressure_viscosity=alpha,
        length=load / load_of_length,
        acceleration_scale=load / (MASS * INITIAL_FILM * FREQUENCY**2),
        squeeze_scale=squeeze,
        force_ratio=force / load,
        pressure_scale=scale,
        steady_load=steady,
    )


def changed(scene: Scene, group: str) -> Scene:
    """A published scene with the changes of a group of CHANGES."""
    more: dict = {"name": f"{scene.name} {group}", "group": group}
    if "orders" in CHANGES[group]:
        more["more_ratios"] = tuple(share * scene.force_ratio for share in ORDER_SHARES[1:])
        more["phases"] = ORDER_PHASES[1:]
    if "flanks" in CHANGES[group]:
        more["backlash"] = BACKLASH
    if "springs" in CHANGES[group]:
        more["compliance"] = 1.0 / (STIFFNESS * FILM_STIFFNESS[scene.law])
        if scene.law == "piezo_viscous" and scene.force_amplitude > STATIC_FORCE:
            more["group"] = f"{group}, {LETS_GO}"
        elif group == "all three":
            more["group"] = f"{group}, {EQUATION[scene.law]}"
        elif scene.name == "published-iso-3":
            more["group"], more["periods"] = f"{group}, chaotic", CHAOTIC_PERIODS
    return replace(scene, **more)


def rest_between_flanks(backlash: float) -> float:
    """Drive film at rest between two iso-viscous films, 1/y - 1/(b - y) = 1."""
    return 2.0 * backlash / (backlash + 2.0 + math.hypot(backlash, 2.0))


def coast_start(scene: Scene) -> float:
    """Coast film at the start, of elastic teeth: y - e G(y, 0) = b - 1 + e, by Newton's method."""
    power = 1.0 if scene.law == "iso_viscous" else 3.5
    wanted = scene.backlash - 1.0 + scene.compliance
    film = wanted
    for _ in range(50):
        load = film**-power
        film -= (film - scene.compliance * load - wanted) / (1.0 + scene.compliance * power * load / film)
    return film


def changed_scenes() -> list[Scene]:
    """The six published scenes changed in every way."""
    published = [scene for scene in all_scenes() if scene.model == "published"]
    return [changed(scene, group) for group in CHANGES for scene in published]


def all_scenes() -> list[Scene]:
    """The twelve scenes: published iso, published piezo, Reynolds iso, Reynolds piezo, three loads each."""
    return [
        make_scene(model, law, factor)
        for model in ("published", "reynolds")
        for law in ("iso_viscous", "piezo_viscous")
        for factor in FORCE_FACTORS
    ]


def scene_text(scene: Scene) -> str:
    """Scene file of the command protocol (see run_peers.py): one `key value` a line, SI then scaled."""
    rows = {
        "scene": scene.name.replace(" ", "-"),
        "model": scene.model,
        "law": scene.law,
        "radius": RADIUS,
        "length": scene.length,
        "viscosity": VISCOSITY,
        "pressure_viscosity": scene.pressure_viscosity,
        "formula_speed": SPEED,
        "entrainment_speed": SPEED if scene.model == "published" else SPEED / 2,
        "mass": MASS,
        "gravity": GRAVITY,
        "frequency": FREQUENCY,
        "static_force": STATIC_FORCE,
        "force_amplitude": scene.force_amplitude,
        "initial_film": INITIAL_FILM,
        "acceleration_scale": scene.acceleration_scale,
        "squeeze_scale": scene.squeeze_scale,
        "force_ratio": scene.force_ratio,
        "pressure_scale": scene.pressure_scale,
        "steady_load": scene.steady_load,
        "periods": scene.periods,
        "sampled_periods": SAMPLED_PERIODS,
        "points_a_period": POINTS_A_PERIOD,
    }
    if scene.is_changed:
        rows["backlash"] = scene.backlash
        rows["compliance"] = scene.compliance
        rows["coast_start"] = coast_start(scene) if scene.backlash * scene.compliance > 0.0 else 0.0
        for order, (ratio, phase) in enumerate(zip(scene.more_ratios, scene.phases, strict=True), start=2):
            rows[f"ratio_{order}"], rows[f"phase_{order}"] = ratio, phase
    return "".join(
        f"{key} {value:.17g}\n" if isinstance(value, float) else f"{key} {value}\n"
        for key, value in rows.items()
    )


def reference_film() -> dict[str, np.ndarray]:
    """Reference y = h/h0 at SAMPLE_TIMES by scene name."""
    with REFERENCE_FILE.open() as stream:
        lines = [line for line in stream if not line.startswith("#")]
    names = lines[0].strip().split(",")
    values = np.loadtxt(lines[1:], delimiter=",")
    return {name: values[:, column] for column, name in enumerate(names)}


def film_error(film: np.ndarray, reference: np.ndarray) -> float:
    """Largest relative error; infinity if the motion has gaps or is not finite."""
    film = np.asarray(film)
    if film.shape != reference.shape or not np.all(np.isfinite(film)):
        return math.inf
    return float(np.max(np.abs(film / reference - 1.0)))


if __name__ == "__main__":
    for each in all_scenes():
        print(scene_text(each))
