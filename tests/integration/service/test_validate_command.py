"""``maquette validate`` with the fake pipeline: from a table to a report."""

from pathlib import Path

import pytest

from api_schemas.results import FitResult
from service.cli import main
from service.commands.validate import REPORT, validate
from service.compute.tasks import ChildSetup, Observe, Parts
from service.jobs.inputs import RESULT
from service.jobs.records import FIT
from tests.integration.service import fake_pipeline
from tests.integration.service.fake_pipeline import scripted_image

FOUND = 92.0
COLUMNS = (
    "person,gender,height_cm,picture,side_picture,waist_girth_navel,waist_girth_navel_2,weight"
)


def fit(setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
    """The fake pipeline's, with a measurement that people have a tape for."""
    files = fake_pipeline.fit(setup, parts, observe)
    result = FitResult.model_validate_json(files[RESULT])
    waist = result.measurements[0].model_copy(
        update={"name": "waist_girth_navel", "value": FOUND, "standard_error": 2.0}
    )
    measured = result.model_copy(update={"measurements": (waist,)})
    return {**files, RESULT: measured.model_dump_json().encode()}


TASKS = {FIT: fit}


def table(folder: Path, *rows: str, columns: str = COLUMNS) -> Path:
    for name in ("a.png", "b.png", "side.png"):
        (folder / name).write_bytes(scripted_image())
    (folder / "spoilt.png").write_bytes(scripted_image({"unusable": True}))
    file = folder / "people.csv"
    file.write_text("\n".join((columns, *rows)) + "\n")
    return file


def cells(folder: Path, measurement: str) -> list[str]:
    lines = (folder / REPORT).read_text().splitlines()
    (row,) = (line for line in lines if line.startswith(f"| {measurement},"))
    return [each.strip() for each in row.strip("|").split("|")]


def test_people_and_tapes_become_a_report(tmp_path, capsys):
    tapes = FOUND - 2.0, FOUND + 3.0
    file = table(
        tmp_path,
        f"one,female,165,a.png,,{tapes[0]},,60",
        f"one,female,165,b.png,,{tapes[0]},,60",
        f"two,male,180,a.png,side.png,{tapes[1] - 0.5},{tapes[1] + 0.5},80",
    )
    assert validate(file, tmp_path / "out", pipeline=__name__) == 0
    _, people, fits, mean_absolute, bias, *rest = cells(tmp_path / "out", "waist_girth_navel")
    assert (people, fits) == ("2", "3")
    assert mean_absolute.startswith("2.5 (2.0 to 3.0)")
    assert bias.startswith("-0.5 (-3.0 to +2.0)")
    repeatability, tape = rest[2:4]
    assert (repeatability, tape) == ("0.0", "0.7")
    by_height, by_both = (float(each.split()[0]) for each in rest[4:])
    assert by_height > 0.0
    assert by_both > 0.0
    assert "waist_girth_navel" in capsys.readouterr().out


def test_a_picture_that_cannot_be_used_is_named_and_the_others_count(tmp_path):
    file = table(
        tmp_path,
        "one,female,165,a.png,,70,,",
        "two,male,180,spoilt.png,,90,,",
        "three,male,180,nowhere.png,,90,,",
    )
    assert validate(file, tmp_path / "out", pipeline=__name__) == 0
    report = (tmp_path / "out" / REPORT).read_text()
    assert "1 of 3 fits of 3 people gave measurements." in report
    assert "row 3, two: " in report
    assert "row 4, three: No such file or directory" in report
    assert cells(tmp_path / "out", "waist_girth_navel")[1] == "1"


@pytest.mark.parametrize(
    ("columns", "row", "told"),
    [
        ("person,gender,picture", "one,female,a.png", "height_cm: Field required"),
        (f"{COLUMNS},bust_girth", "one,female,165,a.png,,,,,90", "chest_girth"),
        (COLUMNS, "one,woman,165,a.png,,70,,", "'female' or 'male'"),
        (
            COLUMNS,
            "one,female,165 cm,a.png,,70,,",
            "Row 2, height_cm: Input should be a valid number",
        ),
        (COLUMNS, "one,female,,a.png,,70,,", "Row 2, height_cm: Field required"),
        (COLUMNS, "", "The file has no row"),
    ],
    ids=["column", "measurement", "gender", "unit", "empty", "no rows"],
)
def test_what_is_wrong_with_a_table_is_told_before_a_fit_is_made(
    tmp_path, capsys, columns, row, told
):
    rows = (row,) if row else ()
    assert (
        validate(table(tmp_path, *rows, columns=columns), tmp_path / "out", pipeline=__name__) == 2
    )
    # Lines are broken wherever they are full, in a path too.
    printed = capsys.readouterr().out.replace("\n", "").replace(" ", "")
    assert told.replace(" ", "") in printed
    assert not (tmp_path / "out").exists()


def test_the_command_hands_over_the_table_and_the_folder(monkeypatch, tmp_path):
    asked: list[object] = []
    monkeypatch.setattr(
        "service.commands.validate.validate",
        lambda file, output, *, models: asked.append((file, output, models)) or 0,
    )
    with pytest.raises(SystemExit) as ended:
        main(["validate", "people.csv", "--output", str(tmp_path)])
    assert ended.value.code == 0
    assert asked == [(Path("people.csv"), tmp_path, None)]
