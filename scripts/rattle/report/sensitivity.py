"""What a report says of a campaign over a design or a sample: which of the varied keys matter, and how."""

from __future__ import annotations

from functools import partial

from rattle import sensitivity
from rattle.campaign_plan import SAMPLE
from rattle.campaign_result import Campaign
from rattle.codes import QUANTITIES
from rattle.command import CommandError, words_of_import
from rattle.counts import counted
from rattle.figures import campaign_look as look
from rattle.figures.sensitivity import draw, draw_directions
from rattle.report import page

CAPTION = "Share of the variance that each key explains, alone and with all others; lines: 95 % intervals."
SIGNED = (
    "Direction of each effect: a bar to the right grows with the key (Spearman's rank correlation). Grey: as "
    "large as chance makes it."
)
HEADS = ("Key", "Alone", "95 %", "With all others", "95 %")
KINDS = ("", "number", "number", "number", "number")


def part(campaign: Campaign) -> list[str]:
    """The indices of every pair as picture and tables, or the sentence that says why there are none."""
    if campaign.kind != SAMPLE and not sensitivity.is_design(campaign):
        return []
    title = page.heading(2, "Which keys matter")
    try:
        studies = sensitivity.studies(campaign, ())
    except CommandError as fault:
        return [title, page.paragraph(str(fault), "note")]
    except ImportError as fault:
        return [title, page.paragraph(f"No indices here. {words_of_import(fault)}.", "note")]
    if campaign.kind == SAMPLE and not any(study.directions for study in studies):
        return []
    parts = [title]
    if any(study.found for study in studies):
        parts.append(page.drawing(partial(draw, campaign, studies), CAPTION, f"{campaign.name} indices"))
    if any(study.directions for study in studies):
        name = f"{campaign.name} directions"
        parts.append(page.drawing(partial(draw_directions, campaign, studies), SIGNED, name))
    for study in studies:
        parts += [page.heading(3, f"Gear {study.pair}")] if study.pair else []
        parts.append(page.paragraph(" ".join(sentences(study))))
        parts += [indices(found, study.keys) for found in study.found]
    return parts


def sentences(study: sensitivity.Study) -> list[str]:
    """What else is known of a pair."""
    words = [f"{counted(study.blocks, 'block')} of {len(study.keys) + 2} scenes."] if study.blocks else []
    if study.left_out:
        words.append(f"{study.left_out} blocks are left out, since scenes of them failed.")
    if study.probability:
        share, low, high = study.probability
        words.append(f"Probability of impacts {share:.1%} (95 % interval {low:.1%} to {high:.1%}).")
    if study.constant:
        words.append(f"The same at all points: {', '.join(map(look.short_name, study.constant))}.")
    return words


def indices(found: sensitivity.Indices, keys: tuple[str, ...]) -> str:
    """The indices of a quantity, each with its interval."""
    rows = [[QUANTITIES[found.quantity].meaning]]
    columns = ((found.first, found.first_error), (found.total, found.total_error))
    for place, key in enumerate(keys):
        cells = []
        for values, errors in columns:
            value, half = float(values[place]), float(errors[place])
            cells += [f"{value:.3f}", f"{value - half:.3f} to {value + half:.3f}"]
        rows.append([page.code(key), *cells])
    return page.table(HEADS, rows, kinds=KINDS)
