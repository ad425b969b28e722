"""The check of a release finds each place that has another one."""

from __future__ import annotations

import pytest

import check_release

CHANGELOG = "# Changelog\n\n## 0.2.0 (2026-11-24)\n\n- New.\n\n## 0.1.0 (2026-11-20)\n\n- First.\n"
CITATION = "cff-version: 1.2.0\nversion: 0.2.0\ndate-released: 2026-11-24\n"
TAG = "rattle 0.2.0\n\n- New."


def reported(version="0.2.0", changelog=CHANGELOG, citation=CITATION, tag=TAG):
    return list(check_release.faults(version, changelog, citation, tag))


def test_a_release_that_agrees_has_no_fault():
    assert reported() == []
    assert check_release.tag_text("0.2.0", CHANGELOG) == TAG


@pytest.mark.parametrize(
    ("words", "changed"),
    (
        ("newest version is not 0.3.0", {"version": "0.3.0", "tag": ""}),
        ("version is 0.1.0, not 0.2.0", {"citation": CITATION.replace("0.2.0", "0.1.0")}),
        ("date-released is missing", {"citation": CITATION.replace("date-released", "date")}),
        ("is not '## VERSION", {"changelog": CHANGELOG.replace(" (2026-11-20)", "")}),
        ("does not stand first", {"changelog": CHANGELOG.replace("## 0.1.0", "## 0.3.0")}),
        ("more than 40", {"changelog": CHANGELOG.replace("- First.\n", "- First.\n" * 41)}),
        ("the message of tag v0.2.0", {"tag": "rattle 0.2.0\n\n- Other."}),
    ),
)
def test_each_disagreement_is_reported(words, changed):
    assert any(words in fault for fault in reported(**changed))
