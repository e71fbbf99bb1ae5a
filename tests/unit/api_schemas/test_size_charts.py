"""Size charts of requests: as JSON and as tables, and what is said of bad ones."""

import json
from pathlib import Path

import pytest

from api_schemas.derivations import DerivationRequest
from api_schemas.measurement_names import suggested_names
from api_schemas.size_chart_csv import ChartTableError, read_chart
from api_schemas.size_charts import MAX_SIZES, BodyRange
from fitter.vocabulary.reach import USUAL_REACH
from service.submissions.refusal import RefusedError
from service.submissions.validation import parsed

M = {"label": "M", "measurements": {"chest_girth": {"low": 94, "high": 98}}}
HEADER = "size,chest_girth,waist_girth_navel\n"


CHARTS = Path(__file__).parent / "data" / "charts"
"""As shops and spreadsheets write them."""


def table(text: str | bytes) -> dict[str, dict[str, object]]:
    chart = read_chart(text.encode() if isinstance(text, str) else text)
    return {
        size.label: {
            name: (each.low, each.high) if isinstance(each, BodyRange) else each
            for name, each in size.measurements.items()
        }
        for size in chart.sizes
    }


@pytest.mark.parametrize(
    "text",
    [
        "size,chest_girth,waist_girth_navel\nM,94-98,80-84\nL,98-102,\n",
        "\ufeffSize; Chest girth ;waist-girth navel\r\nM;94,0–98;80 to 84\r\n;;\r\nL;98 — 102;",
        'size\tchest_girth\twaist_girth_navel\nM\t"94-98"\t80 - 84\t\nL\t98-102\n',
        "size,chest_girth_low,chest_girth_high,waist_girth_navel\nM,94,98,80-84\nL,98,102,\n",
    ],
    ids=["commas", "semicolons", "tabs", "pairs"],
)
def test_a_table_is_read_as_spreadsheets_write_it(text):
    assert table(text) == {
        "M": {"chest_girth": (94.0, 98.0), "waist_girth_navel": (80.0, 84.0)},
        "L": {"chest_girth": (98.0, 102.0)},
    }


def shop(name: str) -> dict[str, dict[str, object]]:
    return table((CHARTS / f"{name}.csv").read_bytes())


def test_units_in_cells_are_read():
    assert shop("cm_unit")["S"] == {
        "chest_girth": (86.0, 91.0),
        "waist_girth_smallest": (66.0, 71.0),
        "hip_girth": (91.0, 97.0),
    }
    assert table("size,chest_girth,weight\nM,34-36 in,110-132 lbs\n")["M"] == {
        "chest_girth": pytest.approx((86.36, 91.44)),
        "weight": pytest.approx((49.895, 59.874), abs=1e-3),
    }


def test_excels_first_line_says_what_parts_the_columns():
    assert shop("excel_sep")["36"]["chest_girth"] == (82.5, 86.0)
    with pytest.raises(ChartTableError, match="Row 3"):
        read_chart(b"sep=;\nsize;chest_girth\nM;a\n")


def test_a_header_may_have_the_unit_and_a_name_that_only_one_measurement_has():
    text = (CHARTS / "head_unit.csv").read_text()
    with pytest.raises(ChartTableError) as caught:
        read_chart(text.encode())
    assert (caught.value.code, "column 'waist'" in caught.value.reason) == ("unknown-value", True)
    assert "waist_girth_smallest" in caught.value.remedy
    read = table(text.replace("Waist", "waist_girth_smallest"))
    assert read["M"] == {
        "chest_girth": (91.0, 97.0),
        "waist_girth_smallest": (71.0, 76.0),
        "hip_girth": (97.0, 102.0),
    }
    assert table("size,Bust (in)\nM,36-38\n") == {
        "M": {"chest_girth": pytest.approx((91.44, 96.52))}
    }


def test_strokes_and_tildes_are_ranges():
    assert shop("slash")["S"]["waist_girth_smallest"] == (66.0, 70.0)
    assert shop("slash")["M"]["waist_girth_smallest"] == (70.0, 74.0)


def test_open_ends_reach_as_far_as_people_do():
    chart = shop("openends")
    assert list(chart["S"]) == ["chest_girth", "waist_girth_smallest"]
    least, most = USUAL_REACH["chest_girth"]
    assert chart["S"]["chest_girth"] == (min(least, 43.0), 86.0)
    assert chart["XL"]["chest_girth"] == (102.0, max(most, 153.0))
    assert chart["XL"]["hip_girth"] == (106.0, 159.0)


def test_columns_of_least_and_most_are_ranges():
    assert shop("minmax_named")["M"] == {
        "chest_girth": (95.0, 100.0),
        "waist_girth_smallest": (85.0, 90.0),
    }


@pytest.mark.parametrize(
    ("cell", "inches"),
    [("34 1/2", 34.5), ("36½", 36.5), ("36 ¼", 36.25), ('34 3/8"', 34.375)],
)
def test_fractions_of_inches_are_read(cell, inches):
    factor = 1.0 if '"' in cell else 2.54
    header = "chest_girth (in)" if factor == 2.54 else "chest_girth"
    cell = cell.replace('"', '""')
    read = table(f'size,{header}\nM,"{cell}"\n')
    assert read == {"M": {"chest_girth": pytest.approx(2.54 * inches)}}


@pytest.mark.parametrize("name", ["inch_named", "inch_frac"])
def test_a_chart_that_looks_like_inches_is_refused(name):
    with pytest.raises(ChartTableError, match="It looks like inches") as caught:
        shop(name)
    assert caught.value.code == "out-of-range"
    assert "Row 2, column 'chest_girth'" in caught.value.reason
    assert "in place of" in caught.value.remedy


@pytest.mark.parametrize(("values", "unit"), [((0.92, 0.98), "metres"), ((36.0, 38.5), "inches")])
def test_a_chart_in_json_is_judged_by_its_units_too(values, unit):
    sizes = [size(label, chest_girth=value) for label, value in zip("ML", values, strict=True)]
    with pytest.raises(RefusedError) as caught:
        parsed(
            DerivationRequest,
            json.dumps({"kind": "size", "chart": {"sizes": sizes}}).encode(),
            whole="body",
            called="the body",
        )
    (fault,) = caught.value.problem.errors
    assert (fault.field, fault.code) == (
        "chart.sizes.0.measurements.chest_girth",
        "out-of-range",
    )
    assert unit in fault.reason


def test_sizes_for_the_unusual_are_no_other_unit():
    assert table(HEADER + "8XL,150-160,\nM,94-98,\n")["8XL"] == {"chest_girth": (150.0, 160.0)}


def test_single_values_are_targets():
    assert table(HEADER + "M,96,82.5\n") == {"M": {"chest_girth": 96.0, "waist_girth_navel": 82.5}}


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        ("", "no-sizes", "empty"),
        (HEADER, "no-sizes", "no rows"),
        ("size\nM\n", "not-a-table", "0 measurements"),
        ("size,waist\nM,80-84\n", "unknown-value", "Row 1, column 'waist'"),
        ("size,chest_girth,chest_girth\nM,1,2\n", "repeated", "Column 3"),
        ("size,,chest_girth\nM,1,2\n", "missing", "Column 2"),
        ("size,chest_girth_low\nM,1\n", "missing", "chest_girth_high"),
        (HEADER + "M,98-94,\n", "low-above-high", "Row 2 ('M'), column 'chest_girth'"),
        (HEADER + "M,94-98,\n\nM,98-102,\n", "repeated", "Row 4"),
        (HEADER + "M,nan,\n", "not-a-range", "holds 'nan'"),
        (HEADER + "M,1e3,\n", "not-a-range", "'1e3'"),
        (HEADER + "M,-5,\n", "not-a-range", "'-5'"),
        (HEADER + "M,940-980,\n", "out-of-range", "940-980"),
        (HEADER + "M,0,\n", "out-of-range", "holds 0"),
        (HEADER + "M,,\n", "missing", "says nothing"),
        (HEADER + ",94-98,\n", "missing", "Row 2 has no label"),
        (HEADER + "M\0,94-98,\n", "unreadable-label", "Row 2"),
        (HEADER + "M,94-98,\nL\u202e,98-102,\n", "unreadable-label", "Row 3"),
        (HEADER + "M,94-98,80-84,5\n", "not-a-table", "Row 2 has more cells"),
        (HEADER + "M,94-98,\nL,100,\n", "mixed-column", "Row 3, column 'chest_girth'"),
        (HEADER + 'M,"94-98\n', "not-a-table", "cannot be read"),
        ("size,chest_girth_low,chest_girth_high\nM,94,\n", "missing", "column 'chest_girth_low'"),
        (HEADER + "".join(f"S{i},{i + 1},\n" for i in range(MAX_SIZES + 1)), "wrong-length", "201"),
    ],
)
def test_a_bad_table_is_refused_with_its_row_and_column(text, code, said):
    with pytest.raises(ChartTableError) as caught:
        read_chart(text.encode())
    assert caught.value.code == code
    assert said in caught.value.reason
    assert caught.value.remedy


def test_what_is_no_text_is_no_table():
    with pytest.raises(ChartTableError, match="UTF-8"):
        read_chart(b"size,\xff\xfe\n")


@pytest.mark.parametrize(
    ("unknown", "meant"),
    [
        ("waist", "waist_girth_navel"),
        ("bust", "chest_girth"),
        ("hips", "hip_girth"),
        ("chst_girth", "chest_girth"),
        ("inside leg", "inseam"),
        ("height", "stature"),
    ],
)
def test_a_name_that_there_is_not_suggests_one_that_there_is(unknown, meant):
    assert meant in suggested_names(unknown)


def test_nothing_is_suggested_for_what_is_like_no_name():
    assert suggested_names("xyz") == ()


def faults(**request: object) -> list[tuple[str, str]]:
    text = json.dumps({"kind": "size"} | request).encode()
    try:
        parsed(DerivationRequest, text, whole="body", called="the body")
    except RefusedError as error:
        return [(each.field, each.code) for each in error.problem.errors]
    return []


def size(label: str, **measurements: object) -> dict[str, object]:
    return {"label": label, "measurements": measurements}


@pytest.mark.parametrize(
    ("request_", "fault"),
    [
        ({"chart": {"sizes": []}}, ("chart.sizes", "wrong-length")),
        ({"chart": {"sizes": [size("M")]}}, ("chart.sizes.0.measurements", "wrong-length")),
        (
            {"chart": {"sizes": [M, size("L", waist=84)]}},
            ("chart.sizes.1.measurements.waist", "unknown-value"),
        ),
        (
            {"chart": {"sizes": [M, size("L", hip_girth={"low": 9, "high": 8})]}},
            ("chart.sizes.1.measurements.hip_girth", "low-above-high"),
        ),
        ({"chart": {"sizes": [M, M]}}, ("chart.sizes.1.label", "repeated")),
        (
            {"chart": {"sizes": [M, size("L", chest_girth=100)]}},
            ("chart.sizes.1.measurements.chest_girth", "mixed-column"),
        ),
        (
            {"chart": {"sizes": [size("M", chest_girth=1e4)]}},
            ("chart.sizes.0.measurements.chest_girth", "out-of-range"),
        ),
        (
            {"chart": {"sizes": [size(f"S{i}", hip_girth=i + 1) for i in range(201)]}},
            ("chart.sizes", "wrong-length"),
        ),
        ({"chart": {"sizes": [M]}, "chart_csv": HEADER}, ("chart_csv", "two-charts")),
        ({"chart_csv": HEADER}, ("chart_csv", "no-sizes")),
        ({"chart": {"sizes": [M]}, "ease": {"hip_girth": 2}}, ("ease.hip_girth", "unknown-value")),
        (
            {"chart": {"sizes": [size("M", hip_girth=100)]}},
            ("tolerances.hip_girth", "tolerance-needed"),
        ),
    ],
)
def test_a_bad_chart_is_refused_with_the_field(request_, fault):
    assert faults(**request_)[0] == fault


def test_numbers_that_are_none_are_refused_in_a_chart():
    text = (
        b'{"kind": "size", "chart": {"sizes": [{"label": "M", "measurements": {"weight": NaN}}]}}'
    )
    with pytest.raises(RefusedError):
        parsed(DerivationRequest, text, whole="body", called="the body")


def test_a_chart_may_be_json_a_table_or_come_later():
    assert faults(chart={"sizes": [M]}) == []
    assert faults(chart_csv=HEADER + "M,94-98,\n") == []
    assert faults() == []
    one = size("one size", head_girth=57)
    tolerance = {"head_girth": {"too_small": 1, "too_large": 2}}
    assert faults(chart={"sizes": [one]}, tolerances=tolerance) == []
