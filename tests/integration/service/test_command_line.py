"""``maquette fit``, ``check`` and ``demo`` with the fake pipeline and answers."""

import csv
import json
import socket
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from api_schemas.results import FitResult
from service.cli import main
from service.commands.check import CheckArguments, check_locally
from service.commands.demo import run_demo
from service.commands.fit import FitArguments, fit_locally
from service.demo_data.sample import Sample, load_sample
from service.version import VERSION
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import POINTS, QUICK, REQUEST

FAKE = "tests.integration.service.fake_pipeline"
FAKE_ANSWERS = "tests.integration.service.fake_answers"
FAKE_SERVE = (sys.executable, "-m", "tests.integration.service.fake_serve")

FAKE_WAIST = 80.0 + len(POINTS)
"""What the pretended pipeline measures, centimetres."""


def arguments(
    folder: Path,
    points: object,
    *,
    image: bytes | None = None,
    mask: bytes | None = None,
    **overrides: object,
) -> FitArguments:
    (folder / "picture.png").write_bytes(scripted_image() if image is None else image)
    (folder / "points.json").write_text(points if isinstance(points, str) else json.dumps(points))
    if mask is not None:
        (folder / "mask.png").write_bytes(mask)
    return FitArguments(
        image=folder / "picture.png",
        points=folder / "points.json",
        mask=None if mask is None else folder / "mask.png",
        models=None,
        output=folder / "out",
        overrides=overrides,
    )


def test_a_fit_without_a_service_writes_its_files_and_prints_its_measurements(tmp_path, capsys):
    assert fit_locally(arguments(tmp_path, REQUEST), pipeline=FAKE) == 0
    result = FitResult.model_validate_json((tmp_path / "out" / "result.json").read_bytes())
    for artifact in result.artifacts:
        assert (tmp_path / "out" / artifact.name).stat().st_size == artifact.size
    printed = capsys.readouterr().out
    assert "waist girth" in printed
    assert f"{FAKE_WAIST:.1f}" in printed
    assert "focal_length_px" in printed


def test_a_fit_without_a_service_writes_its_measurements_as_a_table(tmp_path):
    assert fit_locally(arguments(tmp_path, REQUEST), pipeline=FAKE) == 0
    with (tmp_path / "out" / "measurements.csv").open(newline="") as table:
        (row,) = csv.DictReader(table)
    assert (row["name"], float(row["value"]), row["unit"]) == ("waist_girth", FAKE_WAIST, "cm")


@pytest.mark.parametrize(
    ("said", "asked"),
    [
        ([], None),
        (["--paper"], {}),
        (["--energies", "edges", "shading"], {"energies": ["edges", "shading"]}),
        (["--paper", "--free-height"], {"free_height": True}),
    ],
)
def test_the_papers_own_method_can_be_asked_for(monkeypatch, said, asked):
    given = []
    monkeypatch.setattr("service.commands.fit.fit_locally", lambda each: given.append(each) or 0)
    with pytest.raises(SystemExit):
        main(["fit", "picture.png", *said])
    assert given[0].overrides.get("paper") == asked


@pytest.mark.parametrize(("formats", "told"), [("fbx", "'fbx'"), ("obj,", "''"), ("glb", "'glb'")])
def test_a_format_nobody_writes_is_named_with_those_there_are(capsys, formats, told):
    with pytest.raises(SystemExit) as ended:
        main(["fit", "picture.png", "--points", "points.json", "--formats", formats])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert told in said
    assert "obj, ply, stl" in said


def test_a_folder_without_models_is_told(tmp_path, capsys):
    sample = load_sample()
    given = arguments(tmp_path, sample.request.decode(), image=sample.image, gender="female")
    given = replace(given, models=tmp_path / "nowhere")
    assert fit_locally(given) == 2
    printed = capsys.readouterr().out
    assert "female.npz" in printed
    assert "python -m fitter.training" in printed


def test_a_good_picture_is_said_to_be_usable(tmp_path, capsys):
    picture = tmp_path / "picture.png"
    picture.write_bytes(scripted_image())
    given = CheckArguments(image=picture, points=None, said={"view": "front"})
    assert check_locally(given, answers=FAKE_ANSWERS) == 0
    printed = capsys.readouterr().out
    assert "Nothing was found to be wrong." in printed
    assert "is usable" in printed


def test_a_picture_to_be_taken_again_is_said_with_what_to_do_and_by_the_exit_status(
    tmp_path, capsys
):
    picture = tmp_path / "picture.png"
    picture.write_bytes(scripted_image({"people": 0}))
    given = CheckArguments(image=picture, points=None, said={})
    assert check_locally(given, answers=FAKE_ANSWERS) == 1
    printed = " ".join(capsys.readouterr().out.split())
    assert "blocks (nobody-found): 0 people were found. Have one in the picture." in printed
    assert "Take the picture again." in printed


@pytest.mark.parametrize(
    ("script", "points", "told"),
    [
        (None, {"points": {"nose": [641, 5]}}, "points.nose"),
        (None, None, "No such file"),
        ({"no_detector": True}, {}, "is not installed"),
    ],
)
def test_what_cannot_be_checked_is_told_with_another_exit_status(
    tmp_path, capsys, script, points, told
):
    picture, file = tmp_path / "picture.png", tmp_path / "points.json"
    picture.write_bytes(scripted_image(script))
    if points is not None:
        file.write_text(json.dumps(points))
    given = CheckArguments(image=picture, points=file, said={})
    assert check_locally(given, answers=FAKE_ANSWERS) == 2
    assert told in " ".join(capsys.readouterr().out.split())


def test_a_points_file_may_hold_other_things_and_the_command_line_wins(tmp_path):
    points = {"points": POINTS, "picture": "a painting", "height_m": 1.5, "width": 640}
    given = arguments(tmp_path, points, gender="female", height_m=1.7)
    assert fit_locally(given, pipeline=FAKE) == 0
    result = FitResult.model_validate_json((tmp_path / "out" / "result.json").read_bytes())
    assert result.gender == "female"
    assert result.height_m == 1.7


def test_without_a_points_file_all_points_are_proposed(tmp_path):
    given = arguments(tmp_path, REQUEST, gender="female", height_m=1.7)
    assert fit_locally(replace(given, points=None), pipeline=FAKE) == 0
    result = FitResult.model_validate_json((tmp_path / "out" / "result.json").read_bytes())
    # The pretended pipeline adds a centimetre a point, and proposes none.
    assert result.measurements[0].value == FAKE_WAIST - len(POINTS)


def test_points_can_be_completed_on_the_command_line(tmp_path, capsys):
    picture, points = tmp_path / "picture.png", tmp_path / "points.json"
    picture.write_bytes(scripted_image())
    points.write_text(json.dumps(REQUEST | {"points": {"left_knee": [362.0, 350.0]}}))
    command = ["fit", str(picture), "--points", str(points), "--output", str(tmp_path / "out")]
    for arguments_more, told in ([], "at least 4"), (["--complete-points"], "image"):
        # The picture is a header alone: with points enough, the decoder is the one to complain.
        with pytest.raises(SystemExit) as ended:
            main([*command, *arguments_more])
        assert ended.value.code == 2
        assert told in capsys.readouterr().out


@pytest.mark.parametrize("insists", [False, True])
def test_measurements_can_be_forced_on_the_command_line(tmp_path, monkeypatch, insists):
    asked: list[FitArguments] = []
    monkeypatch.setattr("service.commands.fit.fit_locally", lambda given: asked.append(given) or 0)
    with pytest.raises(SystemExit):
        main(["fit", str(tmp_path / "picture.png"), *(["--force"] if insists else [])])
    assert asked[0].overrides == ({"force": True} if insists else {})


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"points": "no json"}, "points"),
        ({"points": "[1, 2]"}, "points"),
        ({"points": {"points": POINTS}}, "gender"),
        ({"points": REQUEST, "height_m": 3.0}, "height_m"),
        ({"points": REQUEST, "image": b"text"}, "image"),
        ({"points": REQUEST, "mask": scripted_image(width=3)}, "mask"),
        ({"points": REQUEST, "image": scripted_image({"unusable": True})}, "image"),
    ],
)
def test_unusable_input_is_told_and_nothing_is_written(tmp_path, capsys, changes, told):
    points = changes.pop("points")
    assert fit_locally(arguments(tmp_path, points, **changes), pipeline=FAKE) == 2
    assert told in capsys.readouterr().out
    assert not (tmp_path / "out").exists()


def test_a_missing_file_is_named(tmp_path, capsys):
    given = arguments(tmp_path, REQUEST)
    given.image.unlink()
    assert fit_locally(given, pipeline=FAKE) == 2
    assert "picture.png" in capsys.readouterr().out.replace("\n", "")


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
def test_the_demo_shows_bars_prints_the_truth_beside_and_keeps_the_files(tmp_path, capsys):
    output = tmp_path / "demo-output"
    script = {"seconds": 0.3}
    assert run_demo(output, sample=sample(script), serve_command=FAKE_SERVE) == 0
    printed = capsys.readouterr().out
    assert "silhouette and edges" in printed
    assert "+2.0" in printed
    assert "demo-output" in printed.replace("\n", "")
    assert (output / "overlay.png").read_bytes() == scripted_image(script)
    FitResult.model_validate_json((output / "result.json").read_bytes())


@pytest.mark.usefixtures("_quick")
def test_a_demo_whose_fit_fails_says_why(tmp_path, capsys):
    assert run_demo(tmp_path, sample=sample({"unusable": True}), serve_command=FAKE_SERVE) == 1
    assert "The picture ends too early." in capsys.readouterr().out.replace("\n", " ")


def test_help_names_every_command(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["--help"])
    assert ended.value.code == 0
    printed = capsys.readouterr().out
    assert all(name in printed for name in ("serve", "worker", "fit", "demo", "openapi"))


def test_the_version_is_printed(capsys):
    with pytest.raises(SystemExit) as ended:
        main(["--version"])
    assert ended.value.code == 0
    assert capsys.readouterr().out == f"maquette {VERSION}\n"


def test_the_exported_contract_can_be_printed(tmp_path):
    with pytest.raises(SystemExit) as ended:
        main(["openapi", "--output", str(tmp_path / "openapi.json")])
    assert ended.value.code == 0
    assert json.loads((tmp_path / "openapi.json").read_text())["openapi"].startswith("3.1")


def test_keys_are_those_of_the_data_folder_that_is_named(tmp_path, capsys):
    for action in (["create", "shop"], ["list"]):
        with pytest.raises(SystemExit) as ended:
            main(["keys", *action, "--data-dir", str(tmp_path / "shop")])
        assert ended.value.code == 0
    assert " shop fits created" in capsys.readouterr().out
    assert (tmp_path / "shop" / "maquette.sqlite").exists()


def test_the_paper_is_not_fitted_without_a_term(tmp_path, capsys):
    (tmp_path / "p.png").write_bytes(scripted_image())
    (tmp_path / "p.json").write_text(json.dumps(REQUEST))
    given = [str(tmp_path / "p.png"), "--points", str(tmp_path / "p.json"), "--cues", "SE"]
    with pytest.raises(SystemExit) as ended:
        main(["fit", *given, "--energies", "shading", "--output", str(tmp_path / "out")])
    assert ended.value.code == 2
    assert "paper.energies" in capsys.readouterr().out


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


def test_a_setting_that_is_no_number_is_named(capsys, monkeypatch):
    monkeypatch.setenv("MAQUETTE_PORT", "abc")
    with pytest.raises(SystemExit) as ended:
        main(["serve"])
    assert ended.value.code == 78
    assert "MAQUETTE_PORT=abc" in capsys.readouterr().err
