"""The report says what the result says, on one page that stands alone."""

import io
import json
import re
from html.parser import HTMLParser

import pytest
from PIL import Image

from api_schemas.derivation_kinds.report import Language, ReportOptions
from api_schemas.scans import ScanResult
from fitter.measurement.definition_file import load_definitions
from fitter.vocabulary.measurements import CHIEF
from service.worker.derived.report.content import report_content
from service.worker.derived.report.page_html import report_html
from service.worker.derived.report.page_pdf import report_pdf
from service.worker.derived.report.pictures import Picture, ReportPictures
from service.worker.derived.report.scan_content import scan_content
from service.worker.derived.report.wordings import WORDINGS
from tests.e2e.service import REPOSITORY
from tests.unit.service.fit_results import SCAN_RESULT, fit_result, measurement


def picture(caption: str, *, width: int = 60, height: int = 80) -> Picture:
    stream = io.BytesIO()
    Image.new("RGB", (width, height), (200, 120, 40)).save(stream, "PNG")
    return Picture(
        caption=caption,
        media_type="image/png",
        content=stream.getvalue(),
        width=width,
        height=height,
    )


PICTURES = ReportPictures(
    overlay=picture("The body over the picture"),
    sides=tuple(picture(f"Side {number}") for number in range(4)),
)


class Elements(HTMLParser):
    """All elements of a page with their attributes, and its text."""

    def __init__(self, page: bytes) -> None:
        super().__init__()
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.feed(page.decode())

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))

    def handle_data(self, data):
        self.text += data


def rows(**measurements):
    result = fit_result(
        measurements=[measurement(name, **each) for name, each in measurements.items()]
    )
    return {row.name: row for row in report_content(result).measurements}


def test_an_interval_is_196_standard_errors_on_either_side_in_the_api_s_unit():
    row = rows(waist_girth_navel={"value": 80.0, "standard_error": 2.0, "unit": "cm"})
    assert row["Waist, at the navel"].value == "80.0"
    assert row["Waist, at the navel"].unit == "cm"
    assert row["Waist, at the navel"].interval == "76.1 – 83.9"


def test_what_was_given_exactly_and_what_is_unknown_have_no_interval():
    found = rows(
        stature={"standard_error": 0.0, "given": True},
        weight={"standard_error": None},
        hip_girth={"value": 98.0, "standard_error": 1.0, "given": True},
    )
    assert found["Height"].interval == "given"
    assert found["Weight"].interval == "not known"
    assert found["Hip"].interval == "96.0 – 100.0"


def section(result, heading):
    (found,) = (each for each in report_content(result).sections if each.heading == heading)
    return found


def test_light_and_reflectance_are_in_words_and_missing_after_silhouettes_alone():
    light = {"kind": "point", "azimuth_deg": -35.7, "elevation_deg": 30.4, "distance_m": 2.91}
    facts = dict(section(fit_result(light=light), "Light and skin").facts)
    assert facts["Lamp"] == "36° from the left, 30° from above, 2.91 m away"
    assert facts["Skin"] == "throws back 41 % of the light"
    far = light | {"kind": "directional", "azimuth_deg": 12.0, "elevation_deg": -5.0}
    facts = dict(section(fit_result(light=far | {"distance_m": None}), "Light and skin").facts)
    assert facts["Lamp"] == "12° from the right, 5° from below, far away"
    unknown = section(fit_result(light=None, reflectance=None), "Light and skin")
    assert unknown.facts == ()
    assert "Not estimated" in unknown.remarks[0]


def test_what_was_assumed_and_what_to_look_at_are_listed_or_said_to_be_nothing():
    lens = {
        "quantity": "focal_length_35mm",
        "value": 50.0,
        "reason": "Neither the request nor the picture's EXIF data names a focal length.",
    }
    assumed = section(fit_result(assumptions=[lens]), "What was assumed")
    assert assumed.facts[0][0] == "Lens"
    assert assumed.facts[0][1].startswith("50 mm. Neither the request")
    assert section(fit_result(assumptions=[]), "What was assumed").remarks == ("Nothing.",)
    assert section(fit_result(warnings=[]), "Please note").remarks == ("Nothing.",)


def test_where_measurements_are_withheld_the_pages_say_so():
    nobody = fit_result(measurements=[], verdict="no_person", outcome="poor_fit")
    content = report_content(nobody)
    text = Elements(report_html(content, PICTURES)).text
    assert "No measurements are given" in text
    assert "Range (95 %)" not in text
    ((_, ended), *_) = section(nobody, "How sure it is").facts
    assert ended.startswith("No person. ")
    assert pages(report_pdf(content, PICTURES)) == 1


def test_the_page_stands_alone_and_runs_nothing():
    page = report_html(report_content(fit_result()), PICTURES)
    elements = Elements(page)
    tags = {tag for tag, _ in elements.found}
    assert not tags & {"script", "link", "iframe", "object", "a", "form"}
    sources = [attributes["src"] for tag, attributes in elements.found if tag == "img"]
    assert len(sources) == 2
    assert all(source.startswith("data:image/") for source in sources)
    assert all(attributes["alt"] for tag, attributes in elements.found if tag == "img")
    assert not re.search(rb"url\(|@import|https?:", page)
    assert f"{measurement('weight')['value']:.1f}" in elements.text


def test_whatever_the_result_says_is_text_on_the_page():
    hostile = '<img src=x onerror="alert(1)"> & </style><script>'
    warning = {"code": "odd", "message": hostile}
    content = report_content(fit_result(warnings=[warning]))
    elements = Elements(report_html(content, PICTURES))
    assert hostile in elements.text
    assert all("onerror" not in attributes for _, attributes in elements.found)
    assert report_pdf(content, PICTURES).startswith(b"%PDF")


@pytest.mark.parametrize("language", list(Language))
def test_names_are_those_of_the_page(language: Language):
    page = REPOSITORY / "service" / "page" / "src" / "messages" / language / "measures.ts"
    labels = page.read_text().partition("labels: {")[2].partition("\n  },")[0]
    named = WORDINGS[language].measurements
    assert dict(re.findall(r'(\w+): "(.*?)"', labels)) == named
    assert {definition.about.name for definition in load_definitions()} <= named.keys()


def test_no_word_is_of_the_paper_or_of_the_api():
    codes = ("ambiguous-limb-facing", "shading-not-used", "low-silhouette-overlap")
    spoken = "right_upper_arm: by 3 nats under Eq. 1, see limb_facing."
    warnings = [{"code": code, "message": spoken} for code in codes]
    text = Elements(report_html(report_content(fit_result(warnings=warnings)), PICTURES)).text
    body = text.partition("</style>")[2] or text[text.index("Body measurements") :]
    assert not re.search(r"\b(nats|Eq\.|SES?|EXIF|canonical|albedo)\b|[a-z]_[a-z]", body)


def test_the_heading_has_name_and_day_and_values_are_in_the_units_asked_for():
    text = '{"kind": "report", "name": "Ada L.", "date": "2026-11-03", "units": "imperial"}'
    options = ReportOptions.model_validate_json(text)
    waist = measurement("waist_girth_navel", value=76.2, standard_error=2.54, unit="cm")
    weight = measurement("weight", value=70.0, standard_error=None, unit="kg")
    content = report_content(fit_result(measurements=[waist, weight], height_m=1.804), options)
    assert content.subtitle.startswith("Ada L., 3 November 2026, ")
    assert "71.0 in" in content.subtitle
    found = {row.name: row for row in content.measurements}
    row = found["Waist, at the navel"]
    assert (row.value, row.unit, row.interval) == ("30.0", "in", "28.0 – 32.0")
    assert (found["Weight"].value, found["Weight"].unit) == ("154.3", "lb")


@pytest.mark.parametrize("write", [report_html, report_pdf])
def test_the_same_result_gives_the_same_bytes(write):
    content = report_content(fit_result())
    assert write(content, PICTURES) == write(content, PICTURES)


def pages(pdf: bytes) -> int:
    return len(re.findall(rb"/Type /Page\b(?!s)", pdf))


def test_the_pdf_is_one_a4_page_however_much_there_is_to_say():
    long = [{"code": f"w{number}", "message": "Look at this. " * 20} for number in range(12)]
    plain = report_pdf(report_content(fit_result()), PICTURES)
    crowded = report_pdf(report_content(fit_result(warnings=long)), PICTURES)
    for pdf in (plain, crowded):
        assert pages(pdf) == 1
        assert b"/MediaBox [ 0 0 595.2756 841.8898 ]" in pdf


def everything_measured():
    """A result with all that is measured today."""
    names = [definition.about.name for definition in load_definitions()]
    return report_content(fit_result(measurements=[measurement(name) for name in names]))


def test_what_few_ask_for_follows_in_groups_and_nothing_twice():
    content = everything_measured()
    first = [row.name for row in content.measurements]
    later = [row.name for group in content.further for row in group.rows]
    assert first[:2] == ["Height", "Weight"]
    assert len(first) == len(CHIEF)
    assert len({*first, *later}) == len(first) + len(later) == len(load_definitions())
    headings = {group.heading: [row.name for row in group.rows] for group in content.further}
    assert "Armhole" in headings["Girths"]
    assert "Across the back" in headings["Lengths"]
    assert "Waist height" in headings["Heights"]
    assert "Chest depth" in headings["Breadths and depths"]


def test_what_few_ask_for_has_a_second_page():
    content = everything_measured()
    assert pages(report_pdf(content, PICTURES)) == 2
    page = Elements(report_html(content, PICTURES))
    assert len([tag for tag, _ in page.found if tag == "table"]) == 2 + len(content.further)
    assert "Armhole" in page.text


def test_signs_the_pdf_s_fonts_lack_do_not_end_it():
    warning = {"code": "odd", "message": "σ ≥ 3 – 身長"}
    pdf = report_pdf(report_content(fit_result(warnings=[warning])), PICTURES)
    assert pages(pdf) == 1


def test_the_figures_most_people_ask_for_stand_first_and_what_is_for_experts_last():
    named = ("weight", "hip_girth", "waist_girth_smallest", "chest_girth", "neck_girth")
    content = report_content(fit_result(measurements=[measurement(name) for name in named]))
    assert [row.name for row in content.figures] == ["Chest", "Waist", "Hip", "Weight"]
    assert all(row.interval for row in content.figures)
    text = Elements(report_html(content, PICTURES)).text.partition("Body measurements")[2]
    places = [text.index(each) for each in ("Chest", "Measurement", "How sure it is", "Light and")]
    assert places == sorted(places)


def scan_result(**changes: object) -> ScanResult:
    return ScanResult.model_validate_json(json.dumps(SCAN_RESULT | changes))


def test_a_report_of_a_scan_says_what_was_found_in_every_view():
    warning = {"code": "different-people", "message": "The pictures seem to show two people."}
    doubtful = {"code": "segmentation-doubtful", "message": "The outline is doubtful."}
    views = [view | {"warnings": [doubtful]} for view in SCAN_RESULT["views"]]
    content = scan_content(scan_result(warnings=[warning], views=views))
    assert content.title == "Body measurements"
    assert "from 2 pictures" in content.subtitle
    pictures, _, _, warnings = content.sections
    assert [label for label, _ in pictures.facts] == ["Front", "Side"]
    assert warnings.remarks[0] == warning["message"]
    # Both views have the same one: it is said once.
    assert len(warnings.remarks) == 2
    page = Elements(report_html(content, PICTURES))
    assert content.title in page.text
    assert "Agreement" in page.text
    assert "How sure it is" in page.text


def test_measurements_of_a_scan_are_withheld_as_those_of_a_fit():
    page = Elements(report_html(scan_content(scan_result(measurements=[])), PICTURES))
    assert "No measurements are given" in page.text


@pytest.mark.parametrize(("share", "shown"), [(1.0, "100 %"), (0.084, "8 %"), (0.0002, "0.02 %")])
def test_how_pictures_agree_is_told_in_percent(share: float, shown: str):
    _, scan, *_ = scan_content(scan_result(agreement=share)).sections
    assert f"{shown} of pairs" in dict(scan.facts)["Agreement"]
