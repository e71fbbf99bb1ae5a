"""Documents made of a finished fit: the page to print, sizes, body fat."""

import csv
import io
import re
from dataclasses import asdict

import numpy as np
import pytest

from api_schemas.products.documents import EXAMPLE, ChartError, columns_of, read_chart
from fitter.fits.equipment import prepared_model
from fitter.measurement.anthropometry import measure
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.remarks import Note, remark
from service.compute.tasks import UnusableInputError
from service.jobs.inputs import CHART, OVERLAY, PERSON, RESULT, of_view
from tests.unit.service.finished_fit import made, person, png
from tests.unit.service.fit_results import RESULT as DOCUMENT
from tests.unit.service.fit_results import fit_result


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
    view = DOCUMENT["views"][0]
    views = [view, view | {"warnings": [warning]}]
    told = page(views=views, warnings=[warning])
    assert "<li>&lt;b&gt;Look&lt;/b&gt; &amp; see.</li>" in told
    assert "<li>Picture 2: &lt;b&gt;Look" in told


def test_withheld_measurements_say_why():
    told = page(measurements=[], outcome_explanation="Two people.")
    assert "withheld.</b> Two people." in told
    assert "<table" not in told


def test_every_picture_is_shown():
    view = DOCUMENT["views"][0]
    document = fit_result(views=[view, view]).model_dump_json().encode()
    files = {RESULT: document, of_view(1, OVERLAY): png(600, 1200)}
    told = made(kind="print", files=files).files["print.html"].decode()
    assert told.count("<figure ") == 3
    assert "Picture 2" in told


def withholding(name: str) -> dict[str, bytes]:
    """The document of a fit that says too little of a measurement."""
    warning = remark(Note.MEASUREMENTS_WITHHELD, f"Withheld: {name}.", where=[name])
    return {RESULT: fit_result(warnings=[asdict(warning)]).model_dump_json().encode()}


CHART_CSV = "size,chest_girth,waist_girth_navel\nS,80-90,70-80\nM,90-100,80-90\nL,100-110,90-100\n"


def test_a_size_follows_from_a_chart_in_the_request_or_beside_it():
    inline = made(kind="size", chart_csv=CHART_CSV).result
    assert inline == made(kind="size", files={CHART: CHART_CSV.encode()}).result
    result = inline.model_dump()
    chances = [each["probability"] for each in result["sizes"]]
    assert sum(chances) + result["none_fits"] == pytest.approx(1.0)
    assert [each["name"] for each in result["measurements"]] == [
        "chest_girth",
        "waist_girth_navel",
    ]
    assert result["recommended"] == result["sizes"][int(np.argmax(chances))]["label"]


def test_the_table_of_sizes_says_what_the_result_does():
    product = made(kind="size", chart_csv=CHART_CSV)
    table = list(csv.DictReader(io.StringIO(product.files["sizes.csv"].decode())))
    sizes = product.result.model_dump()["sizes"]
    assert [each["label"] for each in table] == ["S", "M", "L"]
    assert [float(each["probability"]) for each in table] == [each["probability"] for each in sizes]


def test_ease_reaches_the_answer():
    result = made(kind="size", chart_csv=CHART_CSV, ease={"chest_girth": 12}).result.model_dump()
    assert result["measurements"][0]["ease"] == pytest.approx(12.0)
    assert result["sizes"] != made(kind="size", chart_csv=CHART_CSV).result.model_dump()["sizes"]


def test_standard_errors_of_what_follows_are_those_of_the_measurements():
    result = made(kind="size", chart_csv=CHART_CSV).result.model_dump()
    someone = person()
    measured = measure(
        prepared_model(Gender.FEMALE).measuring,
        someone.body.shape,
        shape_covariance=someone.shape_covariance,
    )
    found = {each.name: each for each in measured}
    for each in result["measurements"]:
        of_fit = found[each["name"]]
        assert each["value"] == pytest.approx(of_fit.value, abs=0.011)
        assert each["standard_error"] == pytest.approx(of_fit.standard_error, abs=0.0011)
        assert each["within"] + each["too_small"] + each["too_large"] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({RESULT: fit_result(measurements=()).model_dump_json().encode()}, "with `force`"),
        (withholding("chest_girth"), "with the weight"),
        ({PERSON: person(shape_covariance=None).to_bytes()}, "without `paper`"),
    ],
    ids=["withheld", "those of the chart withheld", "by the paper's method"],
)
def test_no_size_follows_where_measurements_or_their_errors_are_not_told(changes, says):
    with pytest.raises(UnusableInputError) as caught:
        made(kind="size", chart_csv=CHART_CSV, files=changes)
    assert (caught.value.error.code, caught.value.error.field) == ("fit-unusable", "kind")
    assert says in caught.value.error.remedy


def test_the_form_of_a_chart_is_read():
    chart = read_chart(b"\xef\xbb\xbfsize,hip_girth,weight\r\n M , 94-98.5 ,\r\n\r\nL,,70-80\r\n")
    assert chart == {"M": {"hip_girth": (94.0, 98.5)}, "L": {"weight": (70.0, 80.0)}}
    assert columns_of(chart) == ("hip_girth", "weight")
    assert list(read_chart(EXAMPLE.encode())) == ["M", "L"]


@pytest.mark.parametrize(
    ("chart", "says"),
    [
        ("", "column 'size'"),
        ("Size;Chest\nM;94-98", "column 'size'"),
        ("size,chest\nM,94-98", "'chest', which is no measurement"),
        ("size,hip_girth,hip_girth\nM,94-98,94-98", "no measurement of its own"),
        ("size,hip_girth", "0 sizes"),
        ("size,hip_girth\n" + "M,94-98\n" * 2, "Row 3 has no label of its own"),
        ("size,hip_girth\n,94-98", "Row 2 has no label"),
        ("size,hip_girth\nM\u202e,94-98", "Row 2 has no label"),
        ("size,hip_girth\nM,94-98,1-2", "Row 2 has 2 of 1 cells"),
        ("size,hip_girth\nM,", "says nothing"),
        ("size,hip_girth\nM,96", "Row 2, column 'hip_girth' holds '96', no range in cm"),
        ("size,hip_girth\nM,98-94", "no range in cm"),
        ("size,hip_girth\nM,37 1/2-39", "no range in cm"),
        ('size,hip_girth\nM,"94', "no CSV"),
        ("size,hip_girth\n" + "".join(f"S{at},94-98\n" for at in range(201)), "201 sizes"),
    ],
)
def test_what_is_not_of_the_form_is_refused_with_a_sentence(chart, says):
    with pytest.raises(ChartError) as caught:
        read_chart(chart.encode())
    assert says in str(caught.value)
    assert caught.value.remedy


def test_body_fat_says_why_it_is_withheld():
    adult, child = (made(kind="composition", age_years=age) for age in (30, 12))
    estimates = adult.result.model_dump()["estimates"]
    assert [each["name"] for each in estimates] == ["us_navy", "cun_bae"]
    for each, least in zip(estimates, (3.52, 4.66), strict=True):
        assert 5.0 < each["percent"] < 60.0
        assert each["standard_error"] > least
    withheld = child.result.model_dump()["estimates"]
    assert [each["percent"] for each in withheld] == [None, None]
    assert all("years, not of 12" in each["withheld"][0] for each in withheld)
    without_neck = made(kind="composition", age_years=30, files=withholding("neck_girth"))
    navy, cun_bae = without_neck.result.model_dump()["estimates"]
    assert "neck_girth" in navy["withheld"][0]
    assert cun_bae["percent"] == estimates[1]["percent"]
    table = list(csv.DictReader(io.StringIO(adult.files["composition.csv"].decode())))
    assert [each["name"] for each in table] == ["us_navy", "cun_bae"]
