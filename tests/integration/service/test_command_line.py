"""The commands fit, demo and validate with the fake pipeline, and what all commands share."""

import csv
import json
import socket
from collections.abc import Sequence
from pathlib import Path

import pytest

from api_schemas.results import FitResult
from service.cli import main
from service.commands.demo import run_demo
from service.commands.fit import PIPELINE, fit_locally, print_result
from service.commands.validate import REPORT, validate
from service.compute.tasks import ChildSetup, Observe, Parts
from service.demo_data.sample import Sample, load_sample
from service.jobs.inputs import RESULT
from service.jobs.records import FIT
from tests.integration.service import fake_pipeline
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.fake_processes import command
from tests.integration.service.harness import FRONT_AND_SIDE, POINTS, QUICK, REQUEST, VIEW
from tests.unit.service.fit_results import fit_result

FAKE = "tests.integration.service.fake_pipeline"
FAKE_SERVE = command("serve")

FAKE_WAIST = 80.0 + len(POINTS)
"""What the pretended pipeline measures, centimetres."""


def fit(folder: Path, request: object, *images: bytes, pipeline: str = FAKE) -> int:
    file = folder / "request.json"
    file.write_text(request if isinstance(request, str) else json.dumps(request))
    pictures = _written(folder, "picture", images or [scripted_image()])
    return fit_locally(file, pictures, folder / "out", pipeline=pipeline)


def _written(folder: Path, name: str, contents: Sequence[bytes]) -> list[Path]:
    files = [folder / f"{name}_{number}.png" for number in range(len(contents))]
    for file, content in zip(files, contents, strict=True):
        file.write_bytes(content)
    return files


def test_a_fit_without_a_service_writes_its_files_and_prints_its_measurements(tmp_path, capsys):
    assert fit(tmp_path, REQUEST) == 0
    result = FitResult.model_validate_json((tmp_path / "out" / "result.json").read_bytes())
    for artifact in result.files:
        assert (tmp_path / "out" / artifact.name).stat().st_size == artifact.size
    printed = capsys.readouterr().out
    assert "waist girth" in printed
    assert f"{FAKE_WAIST:.1f}" in printed
    assert "`height_m`" in printed


def test_a_fit_without_a_service_writes_its_measurements_as_a_table(tmp_path):
    assert fit(tmp_path, REQUEST) == 0
    with (tmp_path / "out" / "measurements.csv").open(newline="") as table:
        (row,) = csv.DictReader(table)
    assert (row["name"], float(row["value"]), row["unit"]) == ("waist_girth", FAKE_WAIST, "cm")


def test_a_folder_of_damaged_models_is_told(tmp_path, capsys, monkeypatch):
    sample = load_sample()
    for name in ("female.npz", "male.npz"):
        (tmp_path / name).touch()
    monkeypatch.setenv("MAQUETTE_MODELS_DIR", str(tmp_path))
    assert fit(tmp_path, sample.request.decode(), sample.image, pipeline=PIPELINE) == 2
    printed = capsys.readouterr().out
    assert "The body model cannot be used." in printed
    assert "male.npz" in printed


@pytest.mark.parametrize(
    ("request_text", "image", "told"),
    [
        ("no json", None, "request.json"),
        (json.dumps({"views": [VIEW]}), None, "gender"),
        (json.dumps(REQUEST), scripted_image({"unusable": True}), "views.0.image"),
        (json.dumps(FRONT_AND_SIDE), None, "views"),
    ],
)
def test_unusable_input_is_told_and_nothing_is_written(tmp_path, capsys, request_text, image, told):
    assert fit(tmp_path, request_text, *([] if image is None else [image])) == 2
    assert told in capsys.readouterr().out
    assert not (tmp_path / "out").exists()


def test_a_missing_file_is_named(tmp_path, capsys):
    (tmp_path / "request.json").write_text(json.dumps(REQUEST))
    with pytest.raises(SystemExit) as ended:
        main(["fit", str(tmp_path / "request.json"), str(tmp_path / "picture.png")])
    assert ended.value.code == 2
    assert "picture.png" in capsys.readouterr().out.replace("\n", "")


def test_where_measurements_are_withheld_it_is_said_how_to_have_them(capsys):
    print_result(fit_result(measurements=[], verdict="implausible"))
    told = capsys.readouterr().out
    assert "force" in told
    assert "implausible" in told
    assert "Measurements, male" not in told


def sample(script: dict[str, object] | None = None) -> Sample:
    return Sample(
        image=scripted_image(script),
        request=json.dumps(REQUEST).encode(),
        truth={"waist_girth": FAKE_WAIST - 2.0},
    )


@pytest.fixture
def _quick(monkeypatch):
    for name, value in QUICK.items():
        monkeypatch.setenv(f"MAQUETTE_{name.upper()}", str(value))


@pytest.mark.usefixtures("_quick")
def test_a_demo_whose_fit_fails_says_why(tmp_path, capsys):
    assert run_demo(tmp_path, sample({"unusable": True}), serve_command=FAKE_SERVE) == 1
    assert "The picture ends too early." in capsys.readouterr().out.replace("\n", " ")


def test_keys_are_those_of_the_data_folder_that_is_named(tmp_path, capsys):
    for action in (["create", "shop"], ["list"]):
        with pytest.raises(SystemExit) as ended:
            main(["keys", *action, "--data-dir", str(tmp_path / "shop")])
        assert ended.value.code == 0
    assert " shop created" in capsys.readouterr().out
    assert (tmp_path / "shop" / "maquette.sqlite").exists()


def test_a_port_in_use_is_said_so_with_what_to_do(capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        with pytest.raises(SystemExit) as ended:
            main(["serve", "--port", str(port)])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert str(port) in said
    assert "--port" in said


FOUND = 92.0
COLUMNS = (
    "person,gender,height_cm,picture,side_picture,waist_girth_navel,waist_girth_navel_2,weight"
)


def fit_waist(setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
    """The fake pipeline's, with a measurement that people have a tape for."""
    files = fake_pipeline.fit(setup, parts, observe)
    result = FitResult.model_validate_json(files[RESULT])
    waist = result.measurements[0].model_copy(
        update={"name": "waist_girth_navel", "value": FOUND, "standard_error": 2.0}
    )
    measured = result.model_copy(update={"measurements": (waist,)})
    return {**files, RESULT: measured.model_dump_json().encode()}


TASKS = {FIT: fit_waist}


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
