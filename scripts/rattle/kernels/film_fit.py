"""The film-thickness regression (32): laws of its form, fitted to Reynolds films and judged on them."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from rattle import _kernels
from rattle.kernels._calls import Numbers, evaluate, finite_numbers, finite_samples, positive_count


class FilmLaw(NamedTuple):
    """Coefficients of h* = c u*^a Wbar^b exp(s w*), eq (32); Wbar = W h0/(12 l u eta0 R), eq (20)."""

    factor: float  #: c [-]
    speed_exponent: float  #: a [-]
    load_exponent: float  #: b [-]
    squeeze_factor: float  #: s [-]


class LawError(NamedTuple):
    """Residuals of a law: its ln h* less that of the points."""

    rms: float  #: root mean square [-]
    bias: float  #: mean [-]
    maximum: float  #: largest absolute one [-]
    r_squared: float  #: share of the variance of ln h* that the law explains; negative: worse than the mean


class FilmFit(NamedTuple):
    """A least-squares law; where the points do not determine it, the one of least norm."""

    law: FilmLaw  #: the fitted coefficients
    error: LawError  #: its residuals on the points
    singular_values: np.ndarray  #: of the design matrix with columns of unit length, falling, four of them
    condition: float  #: ratio of the first to the last of them
    rank: int  #: number of coefficients that the points determine
    unique: bool  #: whether that is all four


class FilmPoints(NamedTuple):
    """Exact piezo-viscous films, one-dimensional arrays of one length, all pure numbers."""

    speed_group: np.ndarray  #: u*
    load_group: np.ndarray  #: Wbar of eq (20)
    squeeze_ratio: np.ndarray  #: w*
    film_ratio: np.ndarray  #: h*


PUBLISHED_FILM_LAW = FilmLaw(*_kernels.wrap_published_film_law().tolist())


def law_film_ratio(law: FilmLaw, speed_group: Numbers, load_group: Numbers, squeeze_ratio: Numbers) -> Any:
    """Film of a law of the form (32).

    A group that is not positive gives NaN or infinity, as the logarithm has it.

    Parameters
    ----------
    law
        Coefficients of the law.
    speed_group, load_group, squeeze_ratio
        u* > 0, Wbar > 0 and w* [-].

    Returns
    -------
    film_ratio
        h* [-].

    Raises
    ------
    TypeError
        The law is no `FilmLaw`.
    """
    coefficients = dict(zip(FilmLaw._fields, _coefficients(law).tolist(), strict=True))
    groups = {"speed_group": speed_group, "load_group": load_group, "squeeze_ratio": squeeze_ratio}
    return evaluate("law_film_ratio", coefficients | groups)


def judge_film_law(
    law: FilmLaw,
    speed_group: np.ndarray,
    load_group: np.ndarray,
    squeeze_ratio: np.ndarray,
    film_ratio: np.ndarray,
) -> LawError:
    """Error of a law of the form (32) on given points: `judge_film_law(law, *points)`.

    Parameters
    ----------
    law
        Coefficients of the law.
    speed_group, load_group, squeeze_ratio, film_ratio
        u*, Wbar, w* and h* [-] of the points, one-dimensional and finite; u*, Wbar and h* positive.

    Returns
    -------
    error
        Residuals of ln h*.

    Raises
    ------
    ValueError
        The points are not of one length, or a number is outside its range.
    """
    points = _points(speed_group, load_group, squeeze_ratio, film_ratio)
    return LawError(*_kernels.wrap_judge_film_law(_coefficients(law), *points).tolist())


def fit_film_law(
    speed_group: np.ndarray, load_group: np.ndarray, squeeze_ratio: np.ndarray, film_ratio: np.ndarray
) -> FilmFit:
    """Least squares of ln h* in the form (32), by LAPACK's dgelsd: `fit_film_law(*points)`.

    Parameters
    ----------
    speed_group, load_group, squeeze_ratio, film_ratio
        u*, Wbar, w* and h* [-] of the points, one-dimensional and finite; u*, Wbar and h* positive.

    Returns
    -------
    fit
        The law with its error, and whether the points determine it.

    Raises
    ------
    ValueError
        There are fewer than five points, they are not of one length, or a number is outside its range.
    numpy.linalg.LinAlgError
        The singular values did not converge.
    """
    points = _points(speed_group, load_group, squeeze_ratio, film_ratio)
    if points[0].size < 5:
        raise ValueError("a fit needs at least five points")
    (status, rank), law, error, conditioning = _kernels.wrap_fit_film_law(*points)
    if status > 1:
        raise np.linalg.LinAlgError("the singular values of the design matrix did not converge")
    values, condition = conditioning[:4], float(conditioning[4])
    return FilmFit(
        FilmLaw(*law.tolist()), LawError(*error.tolist()), values, condition, int(rank), bool(status == 0)
    )


def sample_film_window(
    film_ratio: tuple[float, float],
    squeeze_ratio: tuple[float, float],
    alpha_p: tuple[float, float],
    *,
    film_count: int = 9,
    squeeze_count: int = 9,
    pressure_count: int = 16,
    pressure_factor: float = 1.0,
    load_factor: float = 1.0,
) -> FilmPoints:
    """Exact piezo-viscous films over a window, for `fit_film_law` and `judge_film_law`; errors as of Psi.

    Parameters
    ----------
    film_ratio
        Least and largest h* > 0 [-], sampled evenly in its logarithm.
    squeeze_ratio
        Least and largest w* [-].
    alpha_p
        Least and largest alpha p_max [-], within 0 to 1, sampled at the centres of equal parts.
    film_count, squeeze_count, pressure_count
        Samples of each.
    pressure_factor
        1 for the pressure of eq (6) as printed, 1/2 where u* is formed with u1 + u2 and the pressure with
        the mean.
    load_factor
        Wbar over Psi [-].

    Returns
    -------
    points
        The films.

    Raises
    ------
    ValueError
        A range is out of order or outside its limits, or there are too many films.
    """
    ranges = []
    for name, pair in (("film_ratio", film_ratio), ("squeeze_ratio", squeeze_ratio), ("alpha_p", alpha_p)):
        if not isinstance(pair, tuple) or len(pair) != 2:
            raise TypeError(f"{name} must be a tuple of its least and its largest value")
        ranges += [finite_numbers((), **{name: value}) for value in pair]
    counts = [
        positive_count(film_count, "film_count"),
        positive_count(squeeze_count, "squeeze_count"),
        positive_count(pressure_count, "pressure_count"),
    ]
    factors = finite_numbers(pressure_factor=pressure_factor, load_factor=load_factor)
    size = math.prod(counts)
    if size > np.iinfo(np.int32).max:
        raise ValueError(f"a window of {size} films is too large")
    *points, valid = _kernels.wrap_sample_film_window(
        np.concatenate(ranges), np.array(counts, dtype=np.int32), factors, size
    )
    if not valid:
        raise ValueError(
            "a window needs 0 < h*, 0 <= alpha p <= 1, every range in order and the factors positive"
        )
    return FilmPoints(*points)


def _points(speed_group: Any, load_group: Any, squeeze_ratio: Any, film_ratio: Any) -> list[np.ndarray]:
    """Four sample arrays of one length, groups positive."""
    values = {
        "speed_group": speed_group,
        "load_group": load_group,
        "squeeze_ratio": squeeze_ratio,
        "film_ratio": film_ratio,
    }
    points = {name: finite_samples(value, name) for name, value in values.items()}
    for name, array in points.items():
        if array.size != points["speed_group"].size:
            raise ValueError(f"{name} has {array.size} points, speed_group has {points['speed_group'].size}")
        if name != "squeeze_ratio" and not (array > 0.0).all():
            raise ValueError(f"{name} must be positive")
    return list(points.values())


def _coefficients(law: FilmLaw) -> np.ndarray:
    """The coefficients of a law, all finite, the factor positive."""
    if not isinstance(law, FilmLaw):
        raise TypeError(f"law must be a FilmLaw, not {type(law).__name__}")
    return finite_numbers(positive=("factor",), **law._asdict())
