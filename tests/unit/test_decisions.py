"""The record of decisions: by subject, and short enough to be read."""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "DECISIONS.md").read_text()
ENTRIES = dict(re.findall(r"^### (.+)\n((?:(?!#).+\n?)+)", TEXT, re.MULTILINE))

MOST_BYTES = 60_000
MOST_LINES, MOST_COLUMNS = 8, 120


def anchor(subject: str) -> str:
    return re.sub(r"[^\w -]", "", subject.lower()).replace(" ", "-")


def test_the_index_lists_every_subject_in_its_order():
    subjects = re.findall(r"^## (.+)$", TEXT, re.MULTILINE)
    listed = re.findall(r"^- \[(.+)\]\(#(.+)\)$", TEXT, re.MULTILINE)
    assert listed == [(each, anchor(each)) for each in subjects]


def test_every_heading_of_a_decision_is_followed_by_its_text_and_is_there_once():
    assert re.findall(r"^### (.+)$", TEXT, re.MULTILINE) == list(ENTRIES)


@pytest.mark.parametrize("title", ENTRIES)
def test_a_decision_has_at_most_eight_lines_of_usual_width(title: str):
    lines = ENTRIES[title].splitlines()
    assert len(lines) <= MOST_LINES
    assert max(map(len, lines)) <= MOST_COLUMNS


def test_all_decisions_together_have_at_most_sixty_kilobytes():
    assert len(TEXT.encode()) <= MOST_BYTES


def test_every_file_that_is_linked_exists():
    for link in re.findall(r"\]\(([^)#]+)\)", TEXT):
        assert (ROOT / link).is_file(), link
