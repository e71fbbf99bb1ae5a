"""The size of a chart that the person takes, and the form that charts have."""

import csv
import io

import numpy as np
import pytest

from api_schemas.products.documents import EXAMPLE, ChartError, columns_of, read_chart
from fitter.fits.equipment import prepared_model
from fitter.measurement.anthropometry import measure
from fitter.vocabulary.choices import Gender
from service.compute.tasks import UnusableInputError
from service.jobs.inputs import CHART, PERSON, RESULT
from tests.unit.service.fit_results import fit_result
from tests.unit.service.products.samples import made, person

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
        ({PERSON: person(shape_covariance=None).to_bytes()}, "without `paper`"),
    ],
    ids=["withheld", "by the paper's method"],
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
