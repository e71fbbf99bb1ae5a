"""The documents' lists: codes of findings and warnings, names of code, options of commands."""

import pkgutil
import re
import shlex
from pathlib import Path

from api_schemas import questions as wire
from fitter.fits.error_widening import HARM
from fitter.vocabulary.remarks import Code, Note
from tests.accuracy.__main__ import parser

DOCS = Path(__file__).parents[2] / "service" / "docs"
PICTURES, METHOD, ACCURACY = (
    (DOCS / f"{name}.md").read_text() for name in ("pictures", "method", "accuracy")
)
BY_FITS_ALONE = {"covered", "squeezed", "contradicted"}


def rows(heading: str) -> dict[str, str]:
    """The table's rows below a heading, by the codes in their first cell."""
    (part,) = re.findall(rf"^## {heading}$(.*?)(?=^## |\Z)", PICTURES, re.MULTILINE | re.DOTALL)
    found: dict[str, str] = {}
    for line in re.findall(r"^\| (`.*)$", part, re.MULTILINE):
        first, rest = line.split(" | ", 1)
        for code in re.findall(r"`([a-z-]+)`", first):
            assert code not in found
            found[code] = rest
    return found


def test_findings_are_those_of_the_code_in_its_order_and_of_the_wire():
    checks = list(rows("Findings"))
    assert sorted(checks) == sorted(code.value for code in Code)
    assert [code for code in checks if code not in BY_FITS_ALONE] == [
        code.value for code in Code if code.value not in BY_FITS_ALONE
    ]
    described = re.findall(r"``([a-z-]+)``", (wire.PointsProposal.__doc__ or "").split("Codes:")[1])
    assert set(checks) - BY_FITS_ALONE <= set(described)


def test_what_harms_widens_errors_as_the_code_does():
    harms = rows("What harms")
    assert set(harms) == {code.value for code in HARM}
    for code, harm in HARM.items():
        factors = [float(each) for each in harms[code].strip(" |").split(" | ")]
        assert factors == [harm.chest, harm.waist, harm.hip, harm.weight], code


def test_warnings_are_those_of_the_catalogue():
    of_no_warning = {"height-assumed", "lens-assumed", "points-proposed"}
    places = ("a fit", "proposed points", "products")
    told = {code for place in places for code in rows(f"Warnings of {place}")}
    assert told == {each.value for each in Note} - of_no_warning | {"other-view"}


def test_every_name_of_the_method_can_be_imported():
    names = sorted(set(re.findall(r"`(fitter\.[\w.]+)`", METHOD)))
    assert len(names) > 50
    for name in names:
        assert pkgutil.resolve_name(name) is not None


def test_every_command_of_the_suite_is_understood():
    found = set(re.findall(r"`(?:python -m tests\.accuracy )?(--[^`]+)`", ACCURACY))
    assert "--scan --half reporting" in found
    for options in found:
        parser().parse_args(shlex.split(options))
