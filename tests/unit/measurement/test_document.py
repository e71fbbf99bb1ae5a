from pathlib import Path

from fitter.measurement.definition_file import load_definitions
from fitter.measurement.document import measurements_page

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
