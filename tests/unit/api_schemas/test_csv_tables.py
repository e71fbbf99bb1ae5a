import csv
import io
import json

import pytest

from api_schemas.csv_tables import measurements_csv, measurements_csv_of, models_csv
from api_schemas.products.documents import SizeChance
from api_schemas.results import Measurement


def measurement(**changes: object) -> Measurement:
    known = {
        "name": "waist",
        "value": 80.25,
        "unit": "cm",
        "standard_error": 1.5,
        "low": 77.31,
        "high": 83.19,
        "given": False,
        "definition": 'At the navel, "level".\nBreathing out.',
        "source": "ISO 8559-1",
    }
    return Measurement.model_validate(known | changes)


def test_a_line_a_measurement_and_a_column_a_field():
    rows = [measurement(), measurement(name="weight", unit="kg", given=True, standard_error=None)]
    content = measurements_csv(rows)
    assert content.startswith(
        b"name,value,unit,standard_error,low,high,given,definition,source\r\n"
    )
    first, second = csv.DictReader(io.StringIO(content.decode(), newline=""))
    assert (first["value"], first["unit"], first["given"]) == ("80.25", "cm", "false")
    assert first["definition"] == 'At the navel, "level".\nBreathing out.'
    assert (second["unit"], second["given"], second["standard_error"]) == ("kg", "true", "")


def test_a_result_document_may_hold_other_things_besides():
    document = {"kind": "other", "measurements": [json.loads(measurement().model_dump_json())]}
    assert measurements_csv_of(json.dumps(document).encode()) == measurements_csv([measurement()])


def test_no_measurements_leave_the_header():
    assert measurements_csv([]).count(b"\r\n") == 1


def cell(label: str) -> str:
    """What the table has for a label that somebody typed."""
    size = SizeChance(label=label, probability=0.5)
    (row,) = csv.DictReader(io.StringIO(models_csv([size], SizeChance.model_fields).decode()))
    assert row["probability"] == "0.5", "a number stays one"
    return row["label"]


@pytest.mark.parametrize(
    "label",
    [
        '=HYPERLINK("http://example.org/?"&A1,"L")',
        "+1+1",
        "-2+3",
        "@SUM(A1:A9)",
        "\t=1+1",
        " =1+1",
        "\u00a0=1+1",
        "\uff1d1+1",
    ],
)
def test_no_cell_of_what_somebody_typed_is_a_formula(label):
    assert cell(label) == f"'{label}"


@pytest.mark.parametrize("label", ["M", "38-40", "a=b", "XL +", "'s"])
def test_other_labels_stay_as_they_were_typed(label):
    assert cell(label) == label
