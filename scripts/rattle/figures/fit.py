"""Brings a drawn figure to the width, type and limits that a paper or a slide asks for."""

from __future__ import annotations

import re
from argparse import Namespace
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg, RendererAgg
from matplotlib.cbook import is_math_text
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.text import Text

from rattle.command import CommandError

COLORBAR = "<colorbar>"  # matplotlib's name of axes that hold one
LEAST_TYPE = 7.0  # points
WRAPS = 3  # broken words move the panels, and with them the room for words
NARROW = 0.8  # of the width that a figure is drawn for; below it legends leave the axes
COLUMN = 4.7  # inches; in narrower figures panels stand below each other
WORD = re.compile(r"\$[^$]*\$\S*|\S+")  # mathematics is not broken


def fit(figure: Figure, options: Namespace) -> None:
    """Width in inches, size of type in points, no title, limits of the axes; None leaves a thing as it is.

    Legends are never wider than the figure.
    """
    set_limits(figure, options.xlim, options.ylim)
    if options.no_title:
        drop_titles(figure)
    if options.width is None and options.font_size is None:
        narrow_legends(figure)
        return
    drawn_for = float(figure.get_figwidth())
    ratio = (options.width or drawn_for) / drawn_for
    base = max((text.get_fontsize() for axes in panels(figure) for text in (axes.xaxis.label,)), default=9.0)
    on_page = figure.get_layout_engine() is None  # a page of fixed places shrinks as a whole
    smaller = base * ratio if on_page else max(min(base, LEAST_TYPE), base * min(ratio, 1.0) ** 0.35)
    size = options.font_size or smaller
    scale_type(figure, size / base)
    height = figure.get_figheight() * (ratio if on_page or ratio > 1.0 else ratio**0.5)
    figure.set_size_inches(drawn_for * ratio, height)
    if on_page:
        return
    before = rows_of_text(figure)
    if ratio < NARROW:
        move_legends(figure)
    narrow_legends(figure)
    words = {text: text.get_text() for text in figure.findobj(Text)}
    for _ in range(WRAPS):
        wrap_words(figure, words)
        added = max(rows_of_text(figure) - before, 0) * 1.25 * size / 72.0
        figure.set_figheight(height + added)


def shrink(figure: Figure, width: float) -> None:
    """Make a figure as narrow as a page asks for: smaller panels, type as it is."""
    ratio = width / float(figure.get_figwidth())
    if ratio < 1.0:
        height = float(figure.get_figheight()) * ratio**0.5
        before = rows_of_text(figure)
        figure.set_size_inches(width, height)
    narrow_legends(figure)
    if ratio < 1.0 and figure.get_layout_engine() is not None:
        wrap_words(figure, {text: text.get_text() for text in figure.findobj(Text)})
        figure.set_figheight(height + max(rows_of_text(figure) - before, 0) * 1.25 * 9.0 / 72.0)


def is_narrow(width: float | None) -> bool:
    """Whether a figure of a width [inches] has no room for panels beside each other."""
    return width is not None and width < COLUMN


def panels(figure: Figure) -> list[Axes]:
    """The axes that hold data."""
    return [axes for axes in figure.axes if axes.get_label() != COLORBAR]


def set_limits(figure: Figure, x: tuple[float, float] | None, y: tuple[float, float] | None) -> None:
    """Limits of all x axes, and of the y axis of the first panel."""
    for axes in panels(figure):
        if x:
            _check_logarithmic(axes.get_xscale(), x, "--xlim")
            axes.set_xlim(x)
    if y:
        first = panels(figure)[0]
        _check_logarithmic(first.get_yscale(), y, "--ylim")
        first.set_ylim(y)


def drop_titles(figure: Figure) -> None:
    """No title; where several panels have one, what distinguishes them stays."""
    figure.suptitle("")
    titles = {axes: axes.get_title(loc="left").split("\n") for axes in panels(figure)}
    own = {axes: lines for axes, lines in titles.items() if lines != [""]}
    kept = min(map(len, own.values())) if len(own) > 1 else 0
    for axes, lines in own.items():
        axes.set_title("\n".join(lines[len(lines) - kept :]), loc="left")


def scale_type(figure: Figure, factor: float) -> None:
    """All type by a factor, also that of ticks which are not drawn yet."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            labels = axis.get_ticklabels()
            if labels:
                axis.set_tick_params(labelsize=factor * labels[0].get_fontsize())
    ticks = {
        label for axes in figure.axes for axis in (axes.xaxis, axes.yaxis) for label in axis.get_ticklabels()
    }
    for text in figure.findobj(Text):
        if text not in ticks:
            text.set_fontsize(factor * text.get_fontsize())


def rows_of_text(figure: Figure) -> int:
    """Rows that titles, labels and legends take below and above the panels."""
    titles = sum(_rows(axes.get_title(loc="left")) + _rows(axes.get_xlabel()) for axes in panels(figure))
    below = [legend for legend in figure.legends if legend._outside_loc != "right"]
    legends = sum(-(-len(legend.get_texts()) // legend._ncols) for legend in below)
    return titles + legends + _rows(figure.get_suptitle())


def move_legends(figure: Figure) -> None:
    """All legends into one below the figure; those of several panels below the names of these."""
    entries: list[tuple[object, str]] = []
    own = [(axes, legends_of(axes)) for axes in panels(figure)]
    several = sum(bool(legends) for _, legends in own) > 1
    for axes, legends in own:
        if several and legends:
            name = axes.get_title(loc="left").split("\n")[-1]
            entries += [(_nothing(), name)] if name else []
        for legend in legends:
            entries += entries_of(legend)
            legend.remove()
    for legend in list(figure.legends):
        entries += entries_of(legend)
        legend.remove()
    if not entries:
        return
    unique = entries if several else list({words: (handle, words) for handle, words in entries}.values())
    _legend_below(figure, unique, 1 if several else 3)


def legends_of(axes: Axes) -> list[Legend]:
    return [child for child in axes.get_children() if isinstance(child, Legend)]


def entries_of(legend: Legend) -> list[tuple[object, str]]:
    """Handles and words; a title becomes an entry without a handle."""
    title = legend.get_title().get_text()
    head = [(_nothing(), title)] if title and legend.get_title().get_visible() else []
    words = [text.get_text() for text in legend.get_texts()]
    return [*head, *zip(legend.legend_handles, words, strict=True)]


def narrow_legends(figure: Figure) -> None:
    """Fewer columns in legends that are wider than the figure."""
    width = figure.get_figwidth() * figure.dpi
    for legend in list(figure.legends):
        columns = legend._ncols
        while columns > 1 and legend.get_window_extent(_renderer(figure)).width > 0.97 * width:
            columns -= 1
            entries = list(
                zip(legend.legend_handles, (t.get_text() for t in legend.get_texts()), strict=True)
            )
            size = legend.get_texts()[0].get_fontsize()
            legend.remove()
            legend = _legend_below(figure, entries, columns, size)


def wrap_words(figure: Figure, words: dict[Text, str]) -> None:
    """Titles and labels that are longer than their place, in several lines; `words`: all as they were."""

    def wrap(text: Text, room: float) -> None:
        text.set_text(broken(figure, text, words[text], room))

    figure.draw_without_rendering()
    width, height = figure.get_size_inches() * figure.dpi
    boxes = {axes: axes.get_window_extent() for axes in panels(figure)}
    # A label may come to take one line more.
    spare = figure.dpi / 72.0 * max(axes.yaxis.label.get_fontsize() for axes in boxes)
    for axes, box in boxes.items():
        beside = [other for other in boxes.values() if other.y0 < box.y1 and box.y0 < other.y1]
        end = min((other.x0 for other in beside if other.x0 >= box.x1), default=width)
        start = max((other.x1 for other in beside if other.x1 <= box.x0), default=0.0)
        for title in (axes._left_title, axes.title):
            words[title] = in_one_line(figure, title, words[title], end - box.x0 - spare)
            wrap(title, end - box.x0 - spare)
        middle = 0.5 * (box.x0 + box.x1)
        room = 2.0 * min(middle - start, end - middle)
        wrap(axes.xaxis.label, room if len(beside) == 1 else min(room, 1.3 * box.width))
        wrap(axes.yaxis.label, 1.15 * box.height)
    if figure.get_suptitle():
        wrap(figure._suptitle, 0.98 * width)
    for axes in figure.axes:
        if axes.get_label() == COLORBAR:
            wrap(axes.yaxis.label, height)


def in_one_line(figure: Figure, text: Text, words: str, room: float) -> str:
    """A title without its last parts, as 'What: whose' of 'What: whose, film', where it needs two lines."""
    subject, colon, parts = words.partition(": ")
    while colon and ", " in parts and _width(figure, text, f"{subject}: {parts}") > 0.96 * room:
        parts = parts.rpartition(", ")[0]
    return f"{subject}{colon}{parts}"


def broken(figure: Figure, text: Text, words: str, room: float) -> str:
    """The words in the type of a text, broken where a line is longer than the room [pixels]."""
    lines = []
    for line in words.split("\n"):
        rest: list[str] = []
        for word in WORD.findall(line):
            if rest and _width(figure, text, " ".join([*rest, word])) > 0.96 * room:
                lines.append(" ".join(rest))
                rest = []
            rest.append(word)
        lines.append(" ".join(rest))
    return "\n".join(lines)


def _width(figure: Figure, text: Text, words: str) -> float:
    width, _, _ = _renderer(figure).get_text_width_height_descent(
        words, text.get_fontproperties(), bool(is_math_text(words))
    )
    return width


def _legend_below(
    figure: Figure, entries: Sequence[tuple[object, str]], columns: int, size: float | None = None
) -> Legend:
    handles, words = zip(*entries, strict=True)
    place = "outside lower center"
    size = size or max((axes.xaxis.label.get_fontsize() for axes in panels(figure)), default=9.0) * 0.9
    return figure.legend(list(handles), list(words), loc=place, ncols=columns, fontsize=size)


def _nothing() -> Line2D:
    return Line2D([], [], linestyle="")


def _rows(words: str) -> int:
    return words.count("\n") + 1 if words else 0


def _renderer(figure: Figure) -> RendererAgg:
    return FigureCanvasAgg(figure).get_renderer()


def _check_logarithmic(scale: str, limits: tuple[float, float], option: str) -> None:
    if scale == "log" and min(limits) <= 0.0:
        raise CommandError(f"{option} must be positive: this axis is logarithmic.")
