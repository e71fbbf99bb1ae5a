"""The codes that the page has words for are those of answers, so that none waits in vain."""

import re
from pathlib import Path

import pytest

from api_schemas.problems import PROBLEM_TYPES
from api_schemas.products.bodies import NamedMotion
from fitter.vocabulary.measurements import CHIEF
from fitter.vocabulary.outcomes import Verdict
from fitter.vocabulary.remarks import Code, Note

REPOSITORY = Path(__file__).parents[3]
MESSAGES = REPOSITORY / "service" / "page" / "src" / "messages"
OWN = {"page-error", "unexpected-answer", "unreachable"}
OF_FILES = re.compile(r"(image|mask)-(animated|damaged|empty|too-[a-z]+|unsupported)")
"""Codes that decoding makes of the field and a word."""


def known(name: str) -> set[str]:
    source = (MESSAGES / "answers.ts").read_text(encoding="utf-8")
    (listed,) = re.findall(rf"^  {name}: \{{(.*?)^  \}}", source, re.DOTALL | re.MULTILINE)
    return set(re.findall(r'^    "?([a-z_-]+)"?:', listed, re.MULTILINE))


@pytest.fixture(scope="module")
def code_written() -> str:
    """All that answers are made by."""
    folders = (REPOSITORY / "fitter", REPOSITORY / "service", REPOSITORY / "api_schemas")
    files = [file for folder in folders for file in folder.rglob("*.py")]
    return "\n".join(file.read_text(encoding="utf-8") for file in files)


def test_headings_are_those_of_problem_types():
    assert known("titles") - OWN <= PROBLEM_TYPES.keys()


def test_verdicts_and_remarks_are_those_of_the_service():
    assert known("verdicts") <= {each.value for each in Verdict}
    assert known("remarks") <= {each.value for each in (*Code, *Note)}


def test_codes_of_faults_are_written_somewhere_in_the_service(code_written: str):
    for code in known("faults") - OWN:
        if OF_FILES.fullmatch(code):
            code = "{field}-" + code.partition("-")[2]
        assert f'"{code}"' in code_written, code


def test_the_page_offers_every_named_motion():
    page = MESSAGES.parent / "products" / "kinds" / "animation.tsx"
    (listed,) = re.findall(r"^const MOTIONS.* = \[(.*)\];", page.read_text("utf-8"), re.MULTILINE)
    assert re.findall(r'"([a-z_]+)"', listed) == [each.value for each in NamedMotion]


def test_the_measurements_shown_first_have_labels():
    labels = (MESSAGES / "measures.ts").read_text(encoding="utf-8")
    assert set(CHIEF) <= set(re.findall(r"^    (\w+): \"", labels, re.MULTILINE))
