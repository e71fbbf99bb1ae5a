from pathlib import Path

from fitter.measurement.definition_file import load_definitions
from fitter.measurement.document import ATLAS_FOLDER, measurements_page, sheet_name
from fitter.vocabulary.measurements import Group

PAGE = Path(__file__).parents[3] / "MEASUREMENTS.md"


def test_the_page_of_measurements_is_the_one_the_definitions_make():
    assert PAGE.read_text(encoding="utf-8") == measurements_page(load_definitions())


def test_every_measurement_has_one_row_with_four_cells():
    definitions = load_definitions()
    rows = [line for line in measurements_page(definitions).splitlines() if line.startswith("| `")]
    assert len(rows) == len(definitions)
    for row, definition in zip(rows, definitions, strict=True):
        assert row.startswith(f"| `{definition.about.name}`")
        assert row.count(" | ") == 3


def test_a_measurement_stands_with_its_clause_and_its_field():
    (row,) = [
        line
        for line in measurements_page(load_definitions()).splitlines()
        if line.startswith("| `neck_girth`")
    ]
    assert "Neck girth (5.3.2)" in row
    assert "`neckcircumference`" in row


def test_every_group_has_its_picture():
    page = measurements_page(load_definitions())
    for group in Group:
        assert f"({ATLAS_FOLDER}/{sheet_name(group)})" in page
        assert (PAGE.parent / ATLAS_FOLDER / sheet_name(group)).is_file()
