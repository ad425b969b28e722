"""What each thing to change of a pair leads to over its range, and from where it ends what."""

from __future__ import annotations

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from rattle.countermeasures.levers import Lever
from rattle.countermeasures.scenes import UNKNOWN
from rattle.countermeasures.study import TARGETS, PairStudy
from rattle.countermeasures.words import gain_words, value_words, verdict_word
from rattle.figures import style
from rattle.figures.campaign_look import VERDICT_COLOURS

BAR, MARGIN, HEIGHT = 0.32, 1.25, 0.62
MARKS = {"double-sided impacts": "o", "impacts": "D", "separation": "s"}
COLOURS = VERDICT_COLOURS | {UNKNOWN: style.FAINT_COLOUR}


def draw(pair: PairStudy) -> Figure:
    """A bar for each thing to change, from one end of its range over the present value to the other."""
    figure = Figure(figsize=(style.WIDTH, MARGIN + BAR * len(pair.measures)))
    axes = figure.subplots()
    for place, measure in enumerate(pair.measures):
        lever = measure.lever
        stretches = measure.stretches or ((lever.first, lever.last, pair.now.verdict),)
        for first, last, verdict in stretches:
            low, high = (float(lever.share(end)) for end in (first, last))
            # Where the present value divides a stretch, its two sides have scales of their own.
            for left, right in ((low, min(high, 0.0)), (max(low, 0.0), high)):
                if right > left:
                    axes.barh(
                        place,
                        right - left,
                        HEIGHT,
                        left,
                        color=COLOURS[verdict] if measure.stretches else "white",
                        edgecolor=style.FAINT_COLOUR,
                        linewidth=0.3,
                    )
        for name, end in measure.ends.items():
            axes.plot(end.share, place, MARKS[name], zorder=3, **_look(end.confirmed))
        if measure.effort:
            answer = measure.effort[1]
            gain = gain_words(-answer.change_db(pair.now), answer.error_db(pair.now))
            axes.text(1.38, place, f"{gain} dB", ha="right", va="center", fontsize=7)
    axes.axvline(0.0, color="black", linewidth=1.0)
    count = len(pair.measures)
    axes.set_yticks(range(count), [_words(measure.lever) for measure in pair.measures])
    axes.tick_params(axis="y", length=0, labelsize=6.5)
    axes.set_ylim(count - 0.4, -1.2)
    axes.set_xlim(-1.05, 1.4)
    axes.set_xticks([-1.0, 0.0, 1.0], ["low end", "now", "high end"])
    axes.text(1.38, -0.8, "effort gains", ha="right", va="center", fontsize=7)
    axes.spines["left"].set_visible(False)
    axes.set_title(f"{pair.name}: what each change does")
    _legend(figure, pair)
    return figure


def _look(is_confirmed: bool) -> dict[str, object]:
    """Of a mark: filled where the scene, solved again, does what was predicted."""
    return {"markersize": 4.5, "color": "black" if is_confirmed else "white", "markeredgecolor": "black"}


def _words(lever: Lever) -> str:
    """Name and present value, and below the range."""
    now, first, last = (value_words(value, lever.unit) for value in (lever.now, lever.first, lever.last))
    return f"{lever.name}, {now}\n{first} to {last}"


def _legend(figure: Figure, pair: PairStudy) -> None:
    codes = sorted({code for m in pair.measures for _, _, code in m.stretches})
    handles: list[Patch | Line2D] = [
        Patch(facecolor=COLOURS[code], edgecolor=style.FAINT_COLOUR, linewidth=0.3, label=verdict_word(code))
        for code in codes
    ]
    for name in TARGETS:
        kinds = {m.ends[name].confirmed for m in pair.measures if name in m.ends}
        for is_confirmed in sorted(kinds, reverse=True):
            words = f"no {name} from here" if is_confirmed else f"no {name}: not confirmed"
            handles.append(
                Line2D([], [], marker=MARKS[name], linestyle="", label=words, **_look(is_confirmed))
            )
    if handles:
        figure.legend(handles=handles, loc="outside lower center", ncols=3, fontsize=6.5)
