"""The report in German says what it says in English."""

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass

from api_schemas.derivation_kinds.report import Language, ReportOptions
from service.worker.derived.report.content import report_content
from service.worker.derived.report.english import ENGLISH
from service.worker.derived.report.german import GERMAN
from service.worker.derived.report.page_html import report_html
from service.worker.derived.report.page_pdf import report_pdf
from service.worker.derived.report.scan_content import scan_content
from service.worker.derived.report.wordings import WORDINGS
from tests.e2e.service import REPOSITORY
from tests.unit.service.fit_results import fit_result, measurement
from tests.unit.service.test_report import PICTURES, Elements, pages, scan_result

SERVICE_S_OWN = {"findings", "values", "reasons", "warnings"}
"""Where English leaves something out it shows the service's words, which are English."""

ENGLISH_PARTICLES = re.compile(
    r"\b(the|of|and|with|is|are|from|this|by|it|to|you)\b", re.IGNORECASE
)


def german(**options: object) -> ReportOptions:
    asked = {"kind": "report", "language": "de", **options}
    return ReportOptions.model_validate_json(json.dumps(asked))


def sayings(words: object, path: str = "") -> Iterator[tuple[str, str]]:
    """All texts with where they stand."""
    if is_dataclass(words):
        for field in fields(words):
            yield from sayings(getattr(words, field.name), f"{path}.{field.name}")
    elif isinstance(words, Mapping):
        for key, value in words.items():
            yield from sayings(value, f"{path}.{key}")
    elif isinstance(words, tuple):
        for number, value in enumerate(words):
            yield from sayings(value, f"{path}.{number}")
    elif isinstance(words, str):
        yield path, words


def test_every_language_says_all_that_english_says_with_the_same_figures():
    assert set(WORDINGS) == set(Language)
    said = dict(sayings(GERMAN))
    for path, text in sayings(ENGLISH):
        assert set(re.findall(r"{\w+}", said[path])) == set(re.findall(r"{\w+}", text)), path
    more = {path.split(".")[2] for path in said.keys() - dict(sayings(ENGLISH)).keys()}
    assert more <= SERVICE_S_OWN


def test_no_german_text_has_english_in_it():
    assert [text for _, text in sayings(GERMAN) if ENGLISH_PARTICLES.search(text)] == []


def test_points_are_called_as_on_the_page():
    page = REPOSITORY / "service" / "page" / "src" / "messages" / "de" / "points.ts"
    labels = page.read_text().partition("labels: {")[2].partition("},")[0]
    named = dict(re.findall(r'(\w+): "(.*?)"', labels))
    assert len(named) > 20
    assert named.items() <= GERMAN.remarks.values.items()


def test_numbers_have_a_comma_and_dates_a_german_month():
    waist = measurement("waist_girth_navel", value=80.0, standard_error=2.0, unit="cm")
    weight = measurement("weight", value=74.4, standard_error=0.0, given=True, unit="kg")
    result = fit_result(measurements=[waist, weight], height_m=1.804, gender="male")
    content = report_content(result, german(name="Zoë Groß", date="2026-03-05"))
    assert content.title == "Körpermaße"
    assert content.subtitle.startswith("Zoë Groß, 5. März 2026, Mann, 180,4 cm, aus einem Bild")
    found = {row.name: row for row in content.measurements}
    assert found["Taillenumfang am Nabel"].interval == "76,1 – 83,9"
    assert (found["Gewicht"].value, found["Gewicht"].interval) == ("74,4", "angegeben")


def test_pages_of_fits_and_scans_are_german_throughout():
    warnings = [{"code": code, "message": "Spoken."} for code in GERMAN.remarks.warnings]
    for content in (
        report_content(fit_result(warnings=warnings), german()),
        scan_content(scan_result(warnings=warnings), german()),
        scan_content(scan_result(measurements=[], verdict="no_person"), german()),
    ):
        page = report_html(content, PICTURES)
        assert b'<html lang="de">' in page
        text = Elements(page).text.partition("@media print")[2].partition("}\n\n")[2]
        told = text.replace(*_captions()).replace("Spoken.", "")
        assert "Dies ist kein Medizinprodukt" in told
        assert ENGLISH_PARTICLES.findall(told) == []
        assert pages(report_pdf(content, PICTURES)) >= 1


def _captions() -> tuple[str, str]:
    """Those of the pictures that all tests share are English."""
    return PICTURES.overlay.caption, ""


def test_what_contradicts_a_person_is_said_in_german():
    result = fit_result(measurements=[], verdict="no_person", outcome="poor_fit")
    (light, fit, *_) = report_content(result, german()).sections
    (_, ended), *_ = fit.facts
    assert light.heading == "Licht und Haut"
    assert ended.startswith("Keine Person. An den Punkten")
    assert result.outcome_explanation not in ended
