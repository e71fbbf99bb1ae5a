"""The page about the method: what it names can be imported, and no equation is missing."""

import pkgutil
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "service" / "docs" / "method.md").read_text()
DECISIONS = (ROOT / "DECISIONS.md").read_text()

NAMES = sorted(set(re.findall(r"`(fitter\.[\w.]+)`", PAGE)))

NUMBERED_IN_PAPER = (1, 2)
WITHOUT_A_NUMBER = (
    r"d = U \beta + \mu",
    r"R_{jk}(\varphi)\, e_j",
    r"d = (U G_n)\, \beta' + \mu",
    r"\rho_\eta(x) = \frac{x^2}{\eta^2 + x^2}",
    r"E_1 = E_{Si} + E_{Eg} + E_{Pn}",
    r"E_2 = E_1 + E_{Sh}",
)
SECTIONS = ("3", "3.1", "3.2", "3.3", "4", "5", "6", "7")


def test_names_are_found():
    assert len(NAMES) > 80


@pytest.mark.parametrize("name", NAMES)
def test_every_name_can_be_imported(name: str):
    assert pkgutil.resolve_name(name) is not None


@pytest.mark.parametrize("number", NUMBERED_IN_PAPER)
def test_every_numbered_equation_is_shown_under_its_number(number: int):
    assert f"**Eq. {number}**" in PAGE
    assert rf"\tag{{{number}}}" in PAGE


def test_no_other_number_is_given():
    assert {int(each) for each in re.findall(r"\bEq\. (\d+)|\\tag", PAGE) if each} == set(
        NUMBERED_IN_PAPER
    )
    assert len(re.findall(r"\\tag", PAGE)) == len(NUMBERED_IN_PAPER)


@pytest.mark.parametrize("formula", WITHOUT_A_NUMBER)
def test_equations_without_a_number_are_shown(formula: str):
    assert any(formula in each for each in re.findall(r"\$\$(.*?)\$\$", PAGE, re.DOTALL))


def test_sections_stand_in_the_order_of_the_paper():
    assert tuple(re.findall(r"^## Section (\d(?:\.\d)?)", PAGE, re.MULTILINE)) == SECTIONS


def test_the_decisions_that_are_quoted_have_such_headings():
    headings = re.findall(r"^### (.+)$", DECISIONS, re.MULTILINE)
    quoted = [" ".join(each.split()) for each in re.findall(r'"([A-Z][^"]+)"', PAGE)]
    assert len(quoted) > 15
    assert [each for each in quoted if not any(each in heading for heading in headings)] == []
