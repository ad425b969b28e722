"""Maps, slices and a one-page summary of a campaign."""

from __future__ import annotations

from argparse import ArgumentParser, ArgumentTypeError, Namespace
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path

from matplotlib.figure import Figure

import rattle
from rattle import command, rerun
from rattle.campaign_plan import GRID
from rattle.campaign_result import Campaign
from rattle.campaign_section import new_section
from rattle.figures import campaign_look as look
from rattle.figures import campaign_map, campaign_slice, campaign_summary, style
from rattle.figures.fit import is_narrow
from rattle.outputs import Writer
from rattle.thresholds import thresholds

DESCRIPTION = (
    "Draw a campaign: a map of the verdict, or where that is not recorded of the class, of the loudest "
    "motion where that is recorded, or of any column "
    "over two varied keys (default), columns along one key (--along), or one page on all of it (--summary)."
)
PAGE_WIDTH = 150.0  # mm, the least in which a page can be read
SLICE_COLUMNS = (
    "verdict",
    "film_force_rms",
    "acceleration_maximum",
    "film_minimum",
    "harmonic_distortion",
    "rattle_class",
)


def add_options(parser: ArgumentParser) -> None:
    parser.add_argument("campaign", type=Path, metavar="FILE", help="campaign result, NAME.rattle")
    parser.add_argument(
        "--columns",
        type=command.names,
        metavar="NAME,NAME",
        help="what is drawn; verdict or rattle_class for a map",
    )
    parser.add_argument(
        "--gear",
        metavar="NAME",
        help="draw this gear pair of several; by default each in a figure of its own",
    )
    parser.add_argument(
        "--together",
        action="store_true",
        help="all gear pairs in one figure, a row of maps for each column; of a single pair its maps",
    )
    parser.add_argument("--x", metavar="KEY", help="varied key on the x axis, by default the first")
    parser.add_argument("--y", metavar="KEY", help="varied key on the y axis, by default the next")
    parser.add_argument("--along", metavar="KEY", help="draw columns along this key instead of a map")
    parser.add_argument(
        "--slice",
        type=command.held_key,
        action="append",
        default=[],
        metavar="KEY=VALUE",
        help="hold another varied key at the grid point nearest to this value; by default its middle",
    )
    parser.add_argument(
        "--contours",
        type=contour_names,
        metavar="NAMES",
        help="contours over a map, of frequency, damping, force, or none; by default force over the verdict, "
        "else both others",
    )
    parser.add_argument(
        "--thresholds",
        type=Path,
        action="append",
        default=[],
        metavar="RESULT",
        help="draw these thresholds over a map",
    )
    parser.add_argument(
        "--colours",
        choices=("auto", "linear", "logarithmic"),
        default="auto",
        help="scale of the colours; auto is logarithmic over more than two decades",
    )
    parser.add_argument(
        "--summary", action="store_true", help="draw one page, write inputs of the worst scenes"
    )
    parser.add_argument("--worst", type=command.positive, metavar="N", help="scenes listed on the page (10)")
    parser.add_argument("--by", metavar="COLUMN", help="what the worst are worst by (acceleration_maximum)")
    parser.add_argument("--smallest", action="store_true", help="the smallest in --by are the worst")


def run(options: Namespace) -> None:
    if not options.summary and (options.worst or options.by or options.smallest):
        raise command.CommandError("--worst, --by and --smallest belong to --summary.")
    if options.summary and options.width and 25.4 * options.width < PAGE_WIDTH - 0.1:
        raise command.CommandError(f"--summary is a page; it takes a --width of {PAGE_WIDTH:g} mm or more.")
    if options.together and (options.summary or options.along or options.gear):
        raise command.CommandError(
            "--together draws maps of all gear pairs: not --summary, --along or --gear."
        )
    options.worst = options.worst or 10
    options.by = options.by or "acceleration_maximum"
    campaign = rattle.read_campaign(options.campaign)
    command.note_summary(campaign)
    if not campaign.closed:
        done = int(campaign.done.sum())
        are = "is" if done == 1 else "are"
        command.note(f"{campaign.path} is not finished; {done} of {campaign.row_count} scenes {are} done.")
    if not campaign.done.any():
        raise command.CommandError(f"{campaign.path} holds no scene that is done; there is nothing to draw.")
    slices = command.one_each(options.slice)
    inputs: list[tuple[Path, Writer]] = []
    with style.house_style():
        if options.together and len(campaign.pairs) > 1:
            drawn = [draw_together(campaign, options, slices)]
        else:
            drawn = []
            for alone in (campaign.pair(options.gear),) if options.gear else campaign.pairs:
                if not alone.done.any():
                    command.note(f"no scene of {alone.name} is done; it is left out.")
                elif options.summary:
                    page, scenes = draw_summary(alone, options)
                    drawn.append(page)
                    inputs += scenes
                elif options.along or (len(alone.varied) == 1 and alone.kind == GRID):
                    drawn.append(draw_slices(alone, options, slices))
                else:
                    drawn += draw_maps(alone, options, slices)
        if drawn:
            print(*style.save(drawn, options, inputs), sep="\n")


def draw_maps(
    campaign: Campaign, options: Namespace, slices: dict[str, float]
) -> Iterator[tuple[str, Figure]]:
    """A map of each column asked for, with its stem."""
    if slices and campaign.kind != GRID:
        raise command.CommandError(
            f"{campaign.path} is not a grid but a {campaign.kind} campaign: nothing to slice."
        )
    x, y = plane(campaign, options.x, options.y, slices)
    overlay = overlay_of(options)
    columns = options.columns or usual_columns(campaign)
    check_columns(campaign, columns)
    names = dict.fromkeys(name for column in columns for name in overlay.contours_of(column))
    for name in campaign_map.lacking_contours(campaign, list(names)):
        command.note(f"{campaign.path} does not record what the contours of {name} need; they are left out.")
    if options.thresholds and campaign.kind != GRID:
        raise command.CommandError(f"{campaign.path} is not a grid: no thresholds are drawn over it.")
    if campaign.kind == GRID:
        section = new_section(campaign, (x, y), slices)
        for sentence in section.remarks():
            command.note(sentence)
    for column in columns:
        if campaign.kind == GRID:
            figure = campaign_map.draw(section, column, overlay)
        else:
            figure = campaign_map.draw_points(campaign, x, y, column, overlay)
        yield f"{campaign.name}_map_{column}", figure


def usual_columns(campaign: Campaign) -> list[str]:
    """What a map shows unless a column is asked for: the verdict where that is recorded, else the class.

    Of several motions it is that of the loudest.
    """
    usual = "verdict" if "verdict" in campaign or "loudest_verdict" in campaign else "rattle_class"
    return [look.loudest(campaign, usual)]


def overlay_of(options: Namespace) -> campaign_map.Options:
    """What lies over the cells of maps."""
    results = [rattle.read(path) for path in options.thresholds]
    for result in results:
        result.require_rows("threshold")
    return campaign_map.Options(options.contours, options.colours, tuple(map(thresholds, results)))


def draw_together(campaign: Campaign, options: Namespace, slices: dict[str, float]) -> tuple[str, Figure]:
    """Maps of all gear pairs in one figure."""
    if campaign.kind != GRID:
        raise command.CommandError(
            f"{campaign.path} is not a grid but a {campaign.kind} campaign: draw it without --together."
        )
    columns = options.columns or usual_columns(campaign)
    check_columns(campaign, columns)
    sections = {}
    for gear, alone in zip(campaign.gears, campaign.pairs, strict=True):
        sections[gear] = new_section(alone, plane(alone, options.x, options.y, slices), slices)
    figure = campaign_map.draw_pairs(sections, columns, overlay_of(options), is_narrow(options.width))
    return f"{campaign.name}_pairs", figure


def draw_slices(campaign: Campaign, options: Namespace, slices: dict[str, float]) -> tuple[str, Figure]:
    """Columns along one key."""
    if campaign.kind != GRID:
        raise command.CommandError(
            f"{campaign.path} is not a grid but a {campaign.kind} campaign: it has no slices."
        )
    along = options.along or campaign.varied[0]
    section = new_section(campaign, (along,), slices)
    for sentence in section.remarks():
        command.note(sentence)
    columns = options.columns or [name for name in SLICE_COLUMNS if name in campaign]
    check_columns(campaign, columns)
    figure = campaign_slice.draw(section, columns)
    return f"{campaign.name}_slice_{along.rpartition('.')[2]}", figure


def draw_summary(
    campaign: Campaign, options: Namespace
) -> tuple[tuple[str, Figure], list[tuple[Path, Writer]]]:
    """The page, and the inputs of the worst scenes that it lists."""
    rows = rerun.extreme_rows(campaign, options.by, options.worst, smallest=options.smallest)
    worst = campaign_summary.Worst(list(rows), options.by, options.smallest)
    page = (f"{campaign.name}_summary", campaign_summary.draw(campaign, worst))
    return page, rerun.inputs(campaign, list(rows), options.output / f"{campaign.name}_scenes", "results")


def plane(campaign: Campaign, x: str | None, y: str | None, slices: Collection[str]) -> tuple[str, str]:
    """The two keys of a map: those asked for, filled up with the first ones that vary and are not held."""
    if len(campaign.varied) < 2:
        raise command.CommandError(f"{campaign.path} varies {campaign.varied[0]} only; a map needs two keys.")
    for key in (key for key in (x, y) if key is not None):
        campaign.axis(key)
    rest = [key for key in campaign.varied if key not in (x, y, *slices)]
    if len(rest) < (x is None) + (y is None):
        raise command.CommandError("too many keys are sliced: a map needs two that are not.")
    x = x or rest.pop(0)
    return x, y or rest.pop(0)


def check_columns(campaign: Campaign, columns: Sequence[str]) -> None:
    for name in columns:
        campaign.check_column(name)  # an unknown name ends the work before a picture is drawn


def contour_names(text: str) -> list[str]:
    names = [] if text == "none" else [name.strip() for name in text.split(",")]
    for name in names:
        if name not in campaign_map.CONTOURS:
            raise ArgumentTypeError(f"'{name}' is not one of {', '.join(campaign_map.CONTOURS)}, none")
    return names
