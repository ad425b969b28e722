"""Films between elastic flanks with their pressure in nodes, in Moes' variables, for bench_nodes.py: written
anew from the equations, not from the program's kernels.

    (H^3 F(P) P_X)_X / 6 = H_X + H_T   where P > 0,   P >= 0,
    H = G + c M + X^2/2 - (4/pi) integral of P ln|X - X'| dX',   M = integral of P dX,
    mu Z'' = M_1 - M_2 - F(T),   G_1 = Z,   G_2 = B - Z.

Two discretisations in xi, X = S tan(xi) (1 + tan(xi)^2): *cubic*, the program's but for where the middle
of its grid stands, with a cubic in xi between nodes and flows of fourth order away from the rupture, and
*linear*, that of the prototype: hats in X with their exact logarithmic integrals, flows of second order,
loads by the trapezium rule in xi.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

PA = 1.96e8
FALLEN = 0.25


@dataclass(frozen=True)
class Scene:
    """A scene in SI units; its references are a largest acceleration [m/s2] and a smallest film [m]."""

    name: str
    radius: float
    length: float
    modulus: float
    stiffness: float
    rolling: float
    mass: float
    steady: float
    frequency: float
    amplitudes: tuple[float, ...]
    viscosity: float
    alpha: float
    law: str
    backlash: float
    periods: int
    reference: tuple[float, float]
    spread: float = 3.0

    @property
    def epsilon(self) -> float:
        return (self.viscosity * self.rolling / (self.modulus * self.radius)) ** 0.25

    @property
    def film_unit(self) -> float:
        return self.radius * self.epsilon**2

    @property
    def load_unit(self) -> float:
        return self.modulus * self.radius * self.epsilon**2 * self.length

    @property
    def time_unit(self) -> float:
        return self.radius * self.epsilon / (0.5 * self.rolling)

    @property
    def period(self) -> float:
        return 1.0 / (self.frequency * self.time_unit)

    @property
    def inertia(self) -> float:
        """mu"""
        return self.mass * self.film_unit / (self.time_unit**2 * self.load_unit)

    @property
    def compliance(self) -> float:
        """c, with the plane contact to the depth R"""
        return -4.0 / math.pi * math.log(self.epsilon) + self.modulus * self.length / self.stiffness

    @property
    def gap(self) -> float:
        """B, 0 with one flank"""
        return self.backlash / self.film_unit

    def force(self, time: float) -> float:
        """F(T)"""
        angle = 2.0 * math.pi * time / self.period
        waves = sum(a * math.cos((k + 1) * angle) for k, a in enumerate(self.amplitudes))
        return (self.steady + waves) / self.load_unit

    def acceleration(self, load: float, time: float) -> float:
        """z'' [m/s2]"""
        return (load - self.force(time)) * self.load_unit / self.mass


def place(xi: np.ndarray) -> np.ndarray:
    """X/S"""
    t = np.tan(xi)
    return t * (1.0 + t * t)


def stretch(xi: np.ndarray) -> np.ndarray:
    """dX/dxi over S"""
    t2 = np.tan(xi) ** 2
    return (1.0 + t2) * (1.0 + 3.0 * t2)


def viscosity_of(scene: Scene):
    """ln(eta/eta0) of P, and its slope."""
    if scene.law == "constant":
        return lambda p: (0.0 * p, 0.0 * p)
    log = math.log(scene.viscosity) + 9.67
    power = scene.alpha * PA / log
    unit = scene.modulus * scene.epsilon / PA

    def roelands(p: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        # Trial pressures of a solver may be far below 0.
        base = np.maximum(1.0 + unit * p, 0.05)
        return log * (base**power - 1.0), log * power * unit * base ** (power - 1.0)

    return roelands


@dataclass
class Film:
    """The film of a flank on a grid of n nodes."""

    scene: Scene
    nodes: int
    cubic: bool
    edge: np.ndarray = field(init=False)

    def __post_init__(self) -> None:
        n, scale = self.nodes, self.scene.spread
        step = math.pi / (n + 1)
        at_nodes = -0.5 * math.pi + step * np.arange(1, n + 1)
        at_edges = -0.5 * math.pi + step * (np.arange(n + 1) + 0.5)
        self.edge = scale * place(at_edges)
        node = scale * place(at_nodes)
        self.width = step * scale * stretch(at_edges)
        self.length = np.diff(self.edge)
        self.thicken = viscosity_of(self.scene)
        self.bowl = 0.5 * self.edge**2
        matrix_of = self._cubics if self.cubic else self._hats
        self.load = step * scale * stretch(at_nodes)
        if self.cubic:
            self.load = self._cubics(None)
        contact = self.scene.compliance * self.load
        self.film = contact - 4.0 / math.pi * matrix_of(at_edges if self.cubic else self.edge)
        ends = self.film[:-1] * self.width[:-1, None] + self.film[1:] * self.width[1:, None]
        if self.cubic:
            middle = contact - 4.0 / math.pi * self._cubics(at_nodes)
            self.volume = (ends + 4.0 * step * scale * stretch(at_nodes)[:, None] * middle) / 6.0
            self.hollow = np.diff(self.edge**3) / 6.0
            self.film_at_nodes, self.bowl_at_nodes = middle, 0.5 * node**2
        else:
            self.volume = 0.5 * self.length[:, None] * (self.film[:-1] + self.film[1:])
            self.hollow = 0.5 * self.length * (self.bowl[:-1] + self.bowl[1:])
            self.film_at_nodes, self.bowl_at_nodes = self.film, self.bowl

    def _hats(self, points: np.ndarray) -> np.ndarray:
        """Integrals of hats times ln|X - X'|, a row for each point."""
        n = self.nodes
        ends = self.scene.spread * place(-0.5 * math.pi + math.pi / (n + 1) * np.arange(1, n + 1))
        ends = np.concatenate([[2.0 * ends[0] - ends[1]], ends, [2.0 * ends[-1] - ends[-2]]])
        away = ends[None, :] - points[:, None]
        size = np.abs(away)
        log = np.log(np.maximum(size, 1e-300))
        zeroth = away * (log - 1.0)
        first = 0.5 * away**2 * (log - 0.5)
        matrix = np.zeros((len(points), n))
        for k in range(1, n + 1):
            for low, high, up in ((k - 1, k, True), (k, k + 1, False)):
                span = ends[high] - ends[low]
                of_zeroth = zeroth[:, high] - zeroth[:, low]
                of_first = first[:, high] - first[:, low]
                # The hat is (X' - low)/span or (high - X')/span, X' = point + away.
                inside = (points - ends[low]) * of_zeroth + of_first
                matrix[:, k - 1] += (inside if up else span * of_zeroth - inside) / span
        return matrix

    def _cubics(self, angles: np.ndarray | None) -> np.ndarray:
        """Integrals of the cubics in xi times ln|X - X'|; without angles, without the logarithm."""
        n, scale = self.nodes, self.scene.spread
        step = math.pi / (n + 1)
        abscissas, weights = np.polynomial.legendre.leggauss(24)
        abscissas, weights = 0.5 + 0.5 * abscissas, 0.5 * weights
        places = [None] if angles is None else list(angles)
        matrix = np.zeros((len(places), n))
        for row, angle in enumerate(places):
            for interval in range(n - 1):
                start = -0.5 * math.pi + (interval + 1) * step
                near = 2.0 if angle is None else (angle - start) / step
                cuts = [0.0, near, 1.0] if 1e-9 < near < 1.0 - 1e-9 else [0.0, 1.0]
                for low, high in zip(cuts[:-1], cuts[1:], strict=True):
                    # The fifth power of the distance from a singular end takes the logarithm away.
                    if abs(low - near) < 1e-6:
                        share, part = low + (high - low) * abscissas**5, 5.0 * abscissas**4 * weights
                    elif abs(high - near) < 1e-6:
                        share, part = high - (high - low) * abscissas**5, 5.0 * abscissas**4 * weights
                    else:
                        share, part = low + (high - low) * abscissas, weights
                    xi = start + share * step
                    value = part * (high - low) * step * scale * stretch(xi)
                    if angle is not None:
                        value = value * np.log(scale * np.abs(place(xi) - place(np.array(angle))))
                    bases = (
                        -share * (share - 1.0) * (share - 2.0) / 6.0,
                        (share + 1.0) * (share - 1.0) * (share - 2.0) / 2.0,
                        -(share + 1.0) * share * (share - 2.0) / 2.0,
                        (share + 1.0) * share * (share - 1.0) / 6.0,
                    )
                    for offset, basis in zip((-1, 0, 1, 2), bases, strict=True):
                        if 0 <= interval + offset < n:
                            matrix[row, interval + offset] += value @ basis
        return matrix[0] if angles is None else matrix

    def flows(self, pressures: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Difference of the integral of F dP over each edge, and its slopes in both pressures."""
        padded = np.concatenate([[0.0], pressures, [0.0]])
        low, high = padded[:-1], padded[1:]
        if self.scene.law == "constant":
            return high - low, -np.ones_like(low), np.ones_like(low)
        (a, da), (b, db), (m, dm) = (self.thicken(p) for p in (low, high, 0.5 * (low + high)))
        a, b, m = np.exp(-a), np.exp(-b), np.exp(-m)
        mean, step = (a + 4.0 * m + b) / 6.0, (high - low) / 6.0
        middle = 2.0 * dm * m
        return (high - low) * mean, -mean - step * (middle + da * a), mean - step * (middle + db * b)

    def rates(self, gap: float, pressures: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
        """What the cells gain a time unit, its slopes in pressures and gap, the smallest film at an edge."""
        n = self.nodes
        film = gap + self.bowl + self.film @ pressures
        difference, by_low, by_high = self.flows(pressures)
        slopes = np.zeros((n + 1, n + 2))
        rows = np.arange(n + 1)
        slopes[rows, rows] = by_low
        slopes[rows, rows + 1] = by_high
        if self.cubic:
            inner = rows[2 : n - 1]
            before, behind = pressures[inner - 2], pressures[inner + 1]
            share = np.where(
                before > 0.0, np.clip(behind, 0.0, None) / np.maximum(FALLEN * before, 1e-300), 0.0
            )
            share = np.minimum(share, 1.0) / 24.0
            bent = 2.0 * difference[inner] - difference[inner - 1] - difference[inner + 1]
            more = 2.0 * slopes[inner] - slopes[inner - 1] - slopes[inner + 1]
            difference[inner] += share * bent
            slopes[inner] += share[:, None] * more
        conductance = film**3 / (6.0 * self.width)
        flow = conductance * difference
        by_film = 3.0 * flow / film
        edges = conductance[:, None] * slopes[:, 1:-1] + (by_film - 1.0)[:, None] * self.film
        return np.diff(flow - film), np.diff(edges, axis=0), np.diff(by_film - 1.0), float(film.min())

    def smallest(self, gap: float, pressures: np.ndarray) -> float:
        """Smallest film, by a parabola through the smallest one of edges and nodes and both beside it."""
        films = gap + self.bowl + self.film @ pressures
        if self.cubic:
            both = np.empty(2 * self.nodes + 1)
            both[::2] = films
            both[1::2] = gap + self.bowl_at_nodes + self.film_at_nodes @ pressures
            films = both
        k = int(films.argmin())
        if not 0 < k < len(films) - 1:
            return float(films[k])
        a, b, c = films[k - 1 : k + 2]
        return float(b - (a - c) ** 2 / (8.0 * (a - 2.0 * b + c))) if a - 2.0 * b + c > 0.0 else float(b)


def next_active(pressures: np.ndarray, slopes: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """Nodes under pressure: primal and dual in one test with the diagonal."""
    return pressures * np.diag(slopes) > residual


def steady(film: Film, load: float) -> tuple[float, np.ndarray]:
    """Gap and pressures of a film at rest under a load, from a thick film on."""
    target = min(0.05, load)
    gap = 12.0 * 0.2039 / target
    # Before the middle, as half of Sommerfeld's film has it
    middle = 0.5 * (film.edge[1:] + film.edge[:-1])
    pressures = np.maximum(-middle, 0.0) / (2.0 * gap + middle**2) ** 2
    pressures *= target / (film.load @ pressures)
    while True:
        for _ in range(200):
            rates, slopes, by_gap, _ = film.rates(gap, pressures)
            active = next_active(pressures, -slopes, -rates)
            m = int(active.sum())
            table = np.zeros((m + 1, m + 1))
            table[:m, :m], table[:m, m] = slopes[np.ix_(active, active)], by_gap[active]
            table[m, :m] = film.load[active]
            fixed = np.where(active, 0.0, -pressures)
            right = np.append(-(rates + slopes @ fixed)[active], target - film.load @ (pressures + fixed))
            solution = np.linalg.solve(table, right)
            change = fixed.copy()
            change[active] = solution[:m]
            share = 1.0
            while film.rates(gap + share * solution[m], pressures + share * change)[3] <= 0.0:
                share *= 0.5
            pressures = pressures + share * change
            gap += share * solution[m]
            if share >= 1.0 and np.abs(change).max() < 1e-9 * (pressures.max() + 1e-4):
                break
        else:
            raise ArithmeticError("no film at rest")
        if target >= load:
            return gap, pressures
        target = min(load, 1.4 * target)
