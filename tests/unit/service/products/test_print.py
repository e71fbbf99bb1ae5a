"""The page to print: whole, escaped, and without anything that loads."""

import re

from service.jobs.inputs import OVERLAY, RESULT, of_view
from tests.unit.service.fit_results import RESULT as EXAMPLE
from tests.unit.service.fit_results import fit_result
from tests.unit.service.products.samples import made, png


def page(**changes: object) -> str:
    document = fit_result(**changes).model_dump_json().encode()
    return made(kind="print", files={RESULT: document}).files["print.html"].decode()


def test_the_page_has_every_measurement_with_its_range_and_how_it_is_taken():
    told = page()
    for each in fit_result().measurements:
        assert each.name.replace("_", " ") in told
        if each.low != each.high:
            assert f"{each.low:.1f} to {each.high:.1f}" in told
    assert told.count("<tr>") >= len(fit_result().measurements)
    assert "95 % of true values" in told


def test_the_page_stands_alone():
    told = page()
    sources = re.findall(r'src="([^"]{0,22})', told)
    assert sources == ["data:image/jpeg;base64"] * 2
    assert "<script" not in told
    assert not re.findall(r"(?:href|url)\W", told)
    assert told.startswith("<!doctype html>")
    assert 'lang="en"' in told


def test_what_is_said_is_escaped_and_named_by_its_picture():
    warning = {"code": "x", "severity": "warns", "reason": "<b>Look</b>", "remedy": "& see."}
    warning["where"] = []
    view = EXAMPLE["views"][0]
    views = [view, view | {"warnings": [warning]}]
    told = page(views=views, warnings=[warning])
    assert "<li>&lt;b&gt;Look&lt;/b&gt; &amp; see.</li>" in told
    assert "<li>Picture 2: &lt;b&gt;Look" in told


def test_withheld_measurements_say_why():
    told = page(measurements=[], outcome_explanation="Two people.")
    assert "withheld.</b> Two people." in told
    assert "<table" not in told


def test_every_picture_is_shown():
    view = EXAMPLE["views"][0]
    document = fit_result(views=[view, view]).model_dump_json().encode()
    files = {RESULT: document, of_view(1, OVERLAY): png(600, 1200)}
    told = made(kind="print", files=files).files["print.html"].decode()
    assert told.count("<figure ") == 3
    assert "Picture 2" in told
