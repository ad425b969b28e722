"""Maps of a campaign: class or any column over two varied keys."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from matplotlib import patheffects
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, ListedColormap, Normalize
from matplotlib.contour import ContourSet
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator
from matplotlib.tri import Triangulation

from rattle.campaign_result import Campaign
from rattle.campaign_section import Section
from rattle.figures import campaign_look as look
from rattle.figures import style, threshold_curves
from rattle.thresholds import Thresholds

RATIO_LEVELS = (0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 15.0, 20.0, 30.0, 50.0)
# Dashes, words, form of the labels, and where these stand along a contour.
CONTOUR_LOOKS = {
    "frequency": ("-", r"natural frequency $f_n/f_\mathrm{exc}$", "%g", 0.85),
    "damping": ("--", r"damping ratio $\zeta$", r"$\zeta$ %g", 0.15),
    "force": ("-", "film force rms [N]", "%g", 0.5),
}
CONTOURS = tuple(CONTOUR_LOOKS)
MOST_FORCE_LEVELS = 6
LIMIT_COLOUR = "#00664C"
# Ticks stand on the side where the film law does not hold.
LIMIT_LOOK = [patheffects.withTickedStroke(angle=90, spacing=7, length=0.6)]
SHORTEST_LABELLED = 60.0  # pixels
NO_SEPARATION = 0  # code of the verdict
ROOM_FOR_WORDS = 0.5  # of the width of a map
# Scenes that are spread less across a line than this share of its length lie on it.
SMALLEST_WIDTH = 1e-6


@dataclass(frozen=True)
class Options:
    """Which contours and thresholds lie over a map, and how numbers become colours."""

    contours: Sequence[str] | None = None  # None: those that belong to the column
    colours: str = "auto"
    thresholds: Sequence[Thresholds] = ()

    def contours_of(self, column: str) -> tuple[str, ...]:
        if self.contours is not None:
            return tuple(self.contours)
        return ("force",) if column in look.VERDICTS else ("frequency", "damping")


def draw(section: Section, column: str, options: Options) -> Figure:
    """The map of a grid campaign on a cut with two free keys."""
    figure, axes = _new_figure()
    handles, colours = draw_cells(axes, section, column, options.colours)
    handles += draw_over(axes, section, column, options)
    _finish(figure, axes, section.campaign, column, handles, colours)
    axes.set_title(title(section.campaign, column, section.words))
    return figure


def draw_over(axes: Axes, section: Section, column: str, options: Options) -> list[Line2D]:
    """Limit of the film law, contours and thresholds over the cells; returns legend entries."""
    handles = draw_limit(axes, section) if column in look.VERDICTS else []
    handles += draw_contours(axes, section, options.contours_of(column), column in look.LOUDEST.values())
    for found in options.thresholds:
        handles += threshold_curves.draw_over_map(axes, section, found)
    return handles


def title(campaign: Campaign, column: str, held: str = "") -> str:
    """What is drawn, of which campaign, under a verdict with which film, and what is held."""
    film = style.film_words(campaign) if column in look.VERDICTS else ""
    about = ", ".join(filter(None, (campaign.name, film, held)))
    return f"{look.capital(look.short_name(column))}: {about}"


def draw_pairs(
    sections: Mapping[str, Section], columns: Sequence[str], options: Options, narrow: bool = False
) -> Figure:
    """Gear pairs side by side, a row of maps for each column; in a narrow figure one pair below the other.

    Maps of one column stand in two rows.
    """
    figure, grid = _panels_of_pairs(len(sections), len(columns), narrow)
    handles: dict[str, Patch | Line2D] = {}
    for place, (column, row) in enumerate(zip(columns, grid, strict=True)):
        drawn = []
        for (pair, section), axes in zip(sections.items(), row, strict=True):
            entries, mesh = draw_cells(axes, section, column, options.colours)
            entries += draw_over(axes, section, column, options) if column in look.VERDICTS else []
            drawn += [mesh] if mesh else []
            for entry in entries:
                words = entry.get_label()
                name = words.rpartition(" (")[0] or words
                # What is hatched in one map need not be there in the next.
                hatched = isinstance(entry, Patch) and entry.get_hatch()
                if name not in handles or (hatched and not handles[name].get_hatch()):
                    handles[name] = entry
            axes.set_title(pair if place == 0 else "")
            place_of = axes.get_subplotspec()
            axes.set_xlabel(axes.get_xlabel() if place_of.is_last_row() else "")
            axes.set_ylabel(axes.get_ylabel() if place_of.is_first_col() else "")
            if not look.is_logarithmic(section.free[0]):
                axes.locator_params(axis="x", nbins=3 if len(columns) > 1 and not narrow else 5)
        campaign = section.campaign
        if drawn:
            norm = look.colour_norm(
                np.concatenate([mesh.get_array().compressed() for mesh in drawn]), options.colours
            )
            for mesh in drawn:
                mesh.set_norm(norm)
            figure.colorbar(
                drawn[0],
                ax=list(row),
                label=look.column_label(campaign, column),
                pad=0.02,
                aspect=14 * (len(sections) if narrow else 1),
            )
    if len(columns) > 1 and not narrow:
        for axes in grid[-1]:
            axes.set_xlabel("")
        middle = (len(sections) - 1) // 2
        grid[-1][middle].set_xlabel(look.axis_label(section.free[0]), x=0.5 if len(sections) % 2 else 1.05)
    for column in set(columns).intersection(look.VERDICTS):
        figure.suptitle(
            f"{look.capital(look.short_name(column))} by pair, {style.film_words(section.campaign)}",
            x=0.01,
            ha="left",
            fontsize="medium",
        )
    figure.legend(list(handles.values()), list(handles), loc="outside lower center", ncols=3)
    return figure


def _panels_of_pairs(pairs: int, columns: int, narrow: bool) -> tuple[Figure, Sequence[Sequence[Axes]]]:
    """The figure of so many gear pairs, and of each column its panels."""
    across = pairs if pairs < 3 else -(-pairs // 2)
    if narrow:
        shape = (pairs, columns)
    elif columns == 1:
        shape = (-(-pairs // across), across)
    else:
        shape = (columns, pairs)
    figure = Figure(figsize=(style.WIDTH, 0.9 + (2.1 if columns == 1 and not narrow else 1.75) * shape[0]))
    panels = figure.subplots(*shape, sharex=True, sharey=True, squeeze=False)
    figure.get_layout_engine().set(w_pad=0.03)
    if narrow:
        return figure, panels.T
    if columns > 1:
        return figure, panels
    for axes in panels.ravel()[pairs:]:
        axes.remove()
    return figure, [panels.ravel()[:pairs]]


def draw_points(campaign: Campaign, x: str, y: str, column: str, options: Options) -> Figure:
    """The map of a campaign that is not a grid: a dot for each scene."""
    figure, axes = _new_figure()
    handles, colours = scatter(axes, campaign, x, y, column, options.colours)
    if len(campaign.varied) == 2:  # with more keys, neighbours in the picture are no neighbours
        handles += _point_contours(axes, campaign, x, y, options.contours_of(column))
    _finish(figure, axes, campaign, column, handles, colours)
    others = [look.short_name(key) for key in campaign.varied if key not in (x, y)]
    axes.set_title(title(campaign, column, f"all values of {', '.join(others)}" if others else ""))
    return figure


def draw_cells(
    axes: Axes, section: Section, column: str, colours: str = "auto"
) -> tuple[list[Patch], ScalarMappable | None]:
    """Coloured cells, gaps and doubts hatched; returns legend entries, or what a colour bar needs."""
    campaign = section.campaign
    x, y = section.free
    factor, _ = look.column_scale(campaign, column)
    values = factor * section.values(column)
    edges = look.cell_edges(x), look.cell_edges(y)
    palette = look.code_colours(column)
    if palette is not None:
        handles, drawn = _code_patches(column, values, palette, values.size), None
        colour_map, norm = _code_colours(palette)
        axes.pcolormesh(*edges, values.T, cmap=colour_map, norm=norm, rasterized=True)
    else:
        handles, norm = [], look.colour_norm(values, colours)
        drawn = axes.pcolormesh(*edges, values.T, cmap=look.COLOUR_MAP, norm=norm, rasterized=True)
    done = section.mask(campaign.done)
    for gap in look.gaps(campaign, column):
        handles += _hatch(axes, edges, section.mask(gap.scenes), gap.words, gap.hatch)
    handles += _hatch(axes, edges, ~done, "not done", look.NOT_DONE_HATCH)
    for doubt in look.doubts(campaign, column):
        handles = without(handles, doubt.words)
        handles += _hatch_doubt(axes, edges, section.mask(doubt.scenes), doubt)
    look.set_axis(axes, "x", x, to_edges=True)
    look.set_axis(axes, "y", y, to_edges=True)
    if column in look.VERDICTS:
        _name_calm(axes, section, values)
        if "verdict_verified" not in campaign:
            handles.append(Line2D([], [], linestyle="", label="whether it is verified was not recorded"))
    handles += look.draw_measured_speeds(axes, campaign, {"x": x.key, "y": y.key})
    return handles, drawn


def scatter(
    axes: Axes, campaign: Campaign, x: str, y: str, column: str, colours: str = "auto"
) -> tuple[list, ScalarMappable | None]:
    """A coloured dot for each scene, a cross for each that failed, a ring for each not verified."""
    factor, _ = look.column_scale(campaign, column)
    values = factor * campaign[column]
    known = campaign.done & ~campaign.failed & np.isfinite(values)
    size = float(np.clip(6000.0 / max(known.sum(), 1), 2.0, 30.0))
    palette = look.code_colours(column)
    dots = {"s": size, "linewidths": 0.2, "edgecolors": "black", "rasterized": known.sum() > 5000}
    if palette is not None:
        handles, drawn = _code_patches(column, values[known], palette, int(campaign.done.sum())), None
        colour_map, norm = _code_colours(palette)
    else:
        handles, drawn = [], None
        colour_map, norm = look.COLOUR_MAP, look.colour_norm(values[known], colours)
    points = axes.scatter(
        campaign[x][known], campaign[y][known], c=values[known], cmap=colour_map, norm=norm, zorder=2, **dots
    )
    if palette is None:
        drawn = points
    for position, gap in enumerate(look.gaps(campaign, column)):
        marker = "x+1234|"[position % 7]
        axes.scatter(
            campaign[x][gap.scenes],
            campaign[y][gap.scenes],
            marker=marker,
            s=18,
            linewidths=0.8,
            color="black",
        )
        words = f"{gap.words} ({int(gap.scenes.sum())})"
        handles.append(Line2D([], [], marker=marker, linestyle="", color="black", markersize=5, label=words))
    for doubt in look.doubts(campaign, column):
        scenes, marker = doubt.scenes, doubt.marker
        ring = {"marker": marker, "facecolors": "none", "edgecolors": "black"}
        axes.scatter(campaign[x][scenes], campaign[y][scenes], s=3 * size, linewidths=0.7, zorder=3, **ring)
        words = f"{doubt.words} ({int(scenes.sum())})"
        outline = {"linestyle": "", "color": "black", "markerfacecolor": doubt.colour}
        handles = [*without(handles, doubt.words), Line2D([], [], marker=marker, label=words, **outline)]
    for which, key in (("x", x), ("y", y)):
        look.set_axis(axes, which, campaign.axis(key), to_edges=False)
    handles += look.draw_measured_speeds(axes, campaign, {"x": x, "y": y})
    return handles, drawn


def draw_limit(axes: Axes, section: Section) -> list[Line2D]:
    """An outline of the cells where the film law does not hold; returns its legend entry."""
    found = look.where_law_fails(section.campaign)
    if found is None:
        return []
    where = section.mask(found[0])
    if not where.any():
        return []
    squares = _squares([look.cell_edges(axis) for axis in section.free], where)
    axes.contour(*squares, levels=(0.5,), colors=["white"], linewidths=[2.6])
    line = axes.contour(*squares, levels=(0.5,), colors=[LIMIT_COLOUR], linewidths=[1.4])
    line.set_path_effects(LIMIT_LOOK)
    words = f"{found[1]} ({look.share(int(where.sum()), where.size)})"
    return [Line2D([], [], color=LIMIT_COLOUR, linewidth=1.4, path_effects=LIMIT_LOOK, label=words)]


def draw_contours(axes: Axes, section: Section, names: Sequence[str], loudest: bool = False) -> list[Line2D]:
    """Contours over the cells of a grid, of the loudest motion or that from rest; returns legend entries."""
    x, y = section.free
    if min(x.values.size, y.values.size) < 2:
        return []
    campaign, handles = section.campaign, []
    for name in names:
        column = _contoured(campaign, name, loudest)
        if column is None:
            continue
        grid = np.full(campaign.shape, np.nan)
        grid[campaign.places] = column[campaign.done]
        values = np.ma.masked_invalid(section.cut(grid).T)
        levels = _levels(values.compressed(), name)
        if levels:
            draw_lines = partial(axes.contour, x.values, y.values, values)
            handles.append(_draw_lines(axes, draw_lines, levels, name))
    return handles


def lacking_contours(campaign: Campaign, names: Sequence[str]) -> list[str]:
    """Contours that the campaign cannot give."""
    return [name for name in names if _contoured(campaign, name) is None]


def _point_contours(axes: Axes, campaign: Campaign, x: str, y: str, names: Sequence[str]) -> list[Line2D]:
    handles = []
    for name in names:
        column = _contoured(campaign, name)
        if column is None:
            continue
        known = campaign.done & np.isfinite(column)
        levels = _levels(column[known], name)
        triangles = _triangles(campaign, x, y, known) if levels and known.sum() >= 10 else None
        if triangles is not None:
            draw_lines = partial(axes.tricontour, triangles, column[known], zorder=3)
            handles.append(_draw_lines(axes, draw_lines, levels, name))
    return handles


def _draw_lines(
    axes: Axes, draw_lines: Callable[..., ContourSet], levels: Sequence[float], name: str
) -> Line2D:
    """Contours in the look of their name; returns their legend entry."""
    dashes, words, _, _ = CONTOUR_LOOKS[name]
    lines = draw_lines(levels=levels, colors="black", linewidths=0.9, linestyles=dashes)
    _label(axes, lines, name)
    return Line2D([], [], color="black", linewidth=0.9, linestyle=dashes, label=words)


def _triangles(campaign: Campaign, x: str, y: str, known: np.ndarray) -> Triangulation | None:
    """Triangles between scenes that are neighbours in the picture, whatever the units of its axes.

    None if the scenes lie on a straight line there.
    """
    places = []
    for key in (x, y):
        axis, values = campaign.axis(key), campaign[key][known]
        seen = np.log(values) if look.is_logarithmic(axis) else values
        places.append((seen - seen.min()) / (np.ptp(seen) or 1.0))
    across = np.linalg.svd(np.array(places) - np.mean(places, axis=1, keepdims=True), compute_uv=False)
    if across[1] <= SMALLEST_WIDTH * across[0]:
        return None
    return Triangulation(campaign[x][known], campaign[y][known], Triangulation(*places).triangles)


def _contoured(campaign: Campaign, name: str, loudest: bool = False) -> np.ndarray | None:
    if name == "frequency":
        return look.frequency_ratio(campaign)
    column = {"damping": "damping_ratio", "force": "film_force_rms"}[name]
    if loudest:
        column = look.loudest(campaign, column)
    if column not in campaign:
        return None
    return campaign[column]


def _levels(values: np.ndarray, name: str) -> list[float]:
    """Round levels strictly within the values."""
    if values.size == 0:
        return []
    low, high = float(values.min()), float(values.max())
    if high - low <= 1e-9 * abs(high):
        return []
    if name == "force" and low > 0.0:
        return _levels_of_forces(low, high)
    levels = list(RATIO_LEVELS) if name == "frequency" else []
    within = [level for level in levels if low < level < high]
    if len(within) < 3:
        within = [
            float(level)
            for level in MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(low, high)
            if low < level < high
        ]
    return within


def _levels_of_forces(low: float, high: float) -> list[float]:
    """Levels that grow by about the same factor, no more of them than can be distinguished."""
    decades = 10.0 ** np.arange(math.floor(math.log10(low)), math.log10(high))
    for steps in ((1.0, 2.0, 5.0), (1.0, 3.0), (1.0,)):
        within = [float(step * decade) for decade in decades for step in steps if low < step * decade < high]
        if len(within) <= MOST_FORCE_LEVELS:
            break
    return within


def _label(axes: Axes, lines: ContourSet, name: str) -> None:
    """A label on the longest line of each level, well inside the picture."""
    _, _, form, place = CONTOUR_LOOKS[name]
    points = []
    for level in lines.allsegs:
        segments = [segment for segment in level if len(segment) > 1]
        if not segments:
            continue
        longest = max(segments, key=lambda segment: _length(axes, segment)[-1])
        seen = axes.transData.transform(longest)
        rises = seen[-1] - seen[0]
        if rises[np.argmax(np.abs(rises))] < 0.0:  # to the right, or upwards
            longest = longest[::-1]
        along = _length(axes, longest)
        if along[-1] > SHORTEST_LABELLED:
            points.append(tuple(np.interp(place * along[-1], along, part) for part in longest.T))
    lines.set_path_effects(style.HALO)
    if points:  # an empty list would mean places of matplotlib's own choice
        for label in axes.clabel(lines, fontsize=7, fmt=form, inline_spacing=3, manual=points):
            label.set_path_effects(style.HALO)


def _length(axes: Axes, segment: np.ndarray) -> np.ndarray:
    """Length of a line up to each of its points, in pixels."""
    seen = axes.transData.transform(segment)
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(seen, axis=0).T))])


def _code_colours(palette: Mapping[int, str]) -> tuple[ListedColormap, Normalize]:
    codes = sorted(palette)
    bounds = [
        codes[0] - 0.5,
        *(0.5 * (a + b) for a, b in zip(codes, codes[1:], strict=False)),
        codes[-1] + 0.5,
    ]
    return ListedColormap([palette[code] for code in codes]), BoundaryNorm(bounds, len(codes))


def _code_patches(column: str, values: np.ndarray, palette: Mapping[int, str], whole: int) -> list[Patch]:
    """Legend entries with the share of `whole`: all classes and verdicts, of other codes those that occur."""
    patches = []
    for code, colour in palette.items():
        count = int((values == code).sum())
        if count or column in look.VERDICTS or column in look.CLASSES:
            words = f"{look.words_in_legends(column, code)} ({look.share(count, whole)})"
            patches.append(Patch(facecolor=colour, edgecolor=look.HATCH_COLOUR, linewidth=0.5, label=words))
    return patches


def without(handles: list, words: str) -> list:
    """Legend entries but for those with these words, which an entry that says more takes the place of."""
    return [handle for handle in handles if handle.get_label().rpartition(" (")[0] != words]


def _hatch(axes: Axes, edges: Sequence[np.ndarray], where: np.ndarray, words: str, hatch: str) -> list[Patch]:
    """Hatch the cells where a condition holds; `where` has the indices x, y."""
    if not where.any():
        return []
    area = axes.contourf(
        *_squares(edges, where), levels=(0.5, 1.5), colors=[look.GAP_COLOUR], hatches=[hatch]
    )
    area.set(edgecolor=look.HATCH_COLOUR, linewidth=0.0, hatch_linewidth=0.5)
    return [look.gap_patch(f"{words} ({look.share(int(where.sum()), where.size)})", hatch)]


def _hatch_doubt(
    axes: Axes, edges: Sequence[np.ndarray], where: np.ndarray, doubt: look.Doubt
) -> list[Patch]:
    """Hatch and frame cells over their colours, black on white, which every colour leaves legible."""
    if not where.any():
        return []
    squares = _squares(edges, where)
    for colour, width in (("white", 1.4), ("black", 0.5)):
        area = axes.contourf(*squares, levels=(0.5, 1.5), colors=["none"], hatches=[doubt.hatch])
        area.set(edgecolor=colour, linewidth=0.0, hatch_linewidth=width)
        axes.contour(*squares, levels=(0.5,), colors=[colour], linewidths=[width])
    words = f"{doubt.words} ({look.share(int(where.sum()), where.size)})"
    return [look.doubt_patch(words, doubt)]


def _name_calm(axes: Axes, section: Section, values: np.ndarray) -> None:
    """Write 'no separation' where it is, in the longest row of cells, if that has room for it."""
    best = (0.0, 0.0, 0.0)
    edges = look.cell_edges(section.free[0])
    seen = np.log(edges) if look.is_logarithmic(section.free[0]) else edges
    height = section.free[1].values
    for row, calm in enumerate((values == NO_SEPARATION).T):
        bounds = np.flatnonzero(np.diff(np.concatenate(([False], calm, [False])).astype(int)))
        for first, last in zip(bounds[::2], bounds[1::2], strict=True):
            length = (seen[last] - seen[first]) / np.ptp(seen)
            if length > best[0] + 1e-9:
                middle = (0.5 * (seen[first] + seen[last]) - seen[0]) / np.ptp(seen)
                # The next row is as calm where the first of all is half as high.
                best = (length, middle, float(height[min(row + (row == 0), height.size - 1)]))
    if best[0] > ROOM_FOR_WORDS:
        place = axes.get_yaxis_transform()
        axes.text(best[1], best[2], "no separation", transform=place, ha="center", va="center", fontsize=8)


def _squares(edges: Sequence[np.ndarray], where: np.ndarray) -> tuple[np.ndarray, ...]:
    """Every cell as a square of four equal corners, so that borders follow the cells exactly."""
    x, y = (np.repeat(edge, 2)[1:-1] for edge in edges)
    return x, y, np.repeat(np.repeat(where.T, 2, axis=0), 2, axis=1).astype(float)


def _new_figure() -> tuple[Figure, Axes]:
    figure = Figure(figsize=(style.WIDTH, 4.9))
    axes = figure.subplots()
    axes.set_facecolor("white")
    return figure, axes


def _finish(
    figure: Figure, axes: Axes, campaign: Campaign, column: str, handles: list, colours: ScalarMappable | None
) -> None:
    if colours is not None:
        figure.colorbar(colours, ax=axes, label=look.column_label(campaign, column), pad=0.02, aspect=30)
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=3)
