"""The pages for developers: short, with fields as the contract has them, and codes there are."""

import json
import re
from pathlib import Path

import pytest

from api_schemas.results import FitResult
from service.api.openapi import recorded_examples
from tests.contract.document import REPOSITORY
from tests.contract.request_table import PAGE, parts, request_table
from tests.readme import block

DOCS = REPOSITORY / "service" / "docs"
GUIDE = [*sorted((DOCS / "guide").glob("*.md")), DOCS / "start.md"]
MOST_WORDS = 1_300

OF_FILES = re.compile(r"(image|mask)-(animated|damaged|empty|too-[a-z]+|unsupported)")
"""Codes that decoding makes of the field and a word."""


@pytest.mark.parametrize("page", GUIDE, ids=lambda page: page.stem)
def test_a_page_of_the_guide_is_read_in_some_minutes(page: Path):
    assert len(page.read_text().split()) <= MOST_WORDS


def test_the_fields_are_those_of_the_contract():
    assert parts(PAGE.read_text())[1] == request_table(), "python -m tests.contract.request_table"


def test_every_field_says_what_it_means():
    rows = [line.split(" | ") for line in request_table().splitlines()[2:]]
    assert [row[0] for row in rows if row[-1].strip(" |") == ""] == []


def test_the_annotated_result_is_one():
    text = re.sub(r"\s+// .*", "", block("annotated result"))
    annotated = FitResult.model_validate_json(text)
    recorded = recorded_examples()["answers"]["get_fit_result"]["200"]["sample"]
    assert recorded.keys() <= json.loads(text).keys()
    assert annotated.verdict == "plausible"


def test_codes_to_show_to_visitors_are_those_of_the_service():
    page = (DOCS / "guide" / "develop.md").read_text()
    rows = re.findall(r"^\| (`[a-z].*?) \|", page, re.MULTILINE)
    shown = {code for row in rows for code in re.findall(r"`([a-z-]+)`", row)}
    assert len(shown) > 25
    folders = (REPOSITORY / each for each in ("fitter", "service", "api_schemas"))
    code = "\n".join(file.read_text() for folder in folders for file in folder.rglob("*.py"))
    assert {
        each for each in shown if f'"{each}"' not in code and not OF_FILES.fullmatch(each)
    } == set()
