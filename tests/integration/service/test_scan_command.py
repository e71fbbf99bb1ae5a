"""``maquette scan`` with the fake pipeline."""

import json
from pathlib import Path

import pytest

from api_schemas.scans import ScanResult
from service.cli import main
from service.commands.scan import ScanArguments, scan_locally
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import REQUEST

FAKE = "tests.integration.service.fake_pipeline"


def pictures(folder: Path, count: int = 2) -> list[Path]:
    files = [folder / f"picture_{number}.png" for number in range(count)]
    for file in files:
        file.write_bytes(scripted_image())
    return files


def points_file(folder: Path) -> Path:
    file = folder / "points.json"
    file.write_text(json.dumps(REQUEST))
    return file


def arguments(folder: Path, *, count: int = 2, **changes: object) -> ScanArguments:
    given = {
        "images": pictures(folder, count),
        "views": (),
        "points": [points_file(folder)] * count,
        "models": None,
        "output": folder / "out",
        "overrides": {"weight_kg": 81.5},
        "of_all_views": {"focal_length_35mm": 26.0},
    }
    return ScanArguments(**given | changes)  # type: ignore[arg-type]


def test_a_scan_without_a_service_writes_its_files_and_prints_its_measurements(tmp_path, capsys):
    assert scan_locally(arguments(tmp_path, count=3), pipeline=FAKE) == 0
    result = ScanResult.model_validate_json((tmp_path / "out" / "result.json").read_bytes())
    assert [each.view for each in result.views] == ["front", "side", "other"]
    for artifact in result.artifacts:
        assert (tmp_path / "out" / artifact.name).stat().st_size == artifact.size
    assert "weight,81.5,kg" in (tmp_path / "out" / "measurements.csv").read_text()
    printed = capsys.readouterr().out
    assert "View 1, side: converged" in printed
    assert "81.5" in printed


def test_what_pictures_show_may_be_said(tmp_path):
    given = arguments(tmp_path, views=("back", "front"))
    assert scan_locally(given, pipeline=FAKE) == 0
    result = ScanResult.model_validate_json((tmp_path / "out" / "result.json").read_bytes())
    assert [each.view for each in result.views] == ["back", "front"]


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"count": 1}, "views: A scan has 2 to 6 pictures, not 1."),
        ({"views": ("front", "front")}, "views.1.view: Two pictures are said to show the front."),
        ({"views": ("above",)}, "views.0.view"),
        ({"images": [Path("nowhere.png")] * 2}, "nowhere.png"),
        ({"overrides": {"height_m": 180.0}}, "height_m"),
    ],
)
def test_what_makes_no_scan_is_told_and_nothing_written(tmp_path, capsys, changes, told):
    assert scan_locally(arguments(tmp_path, **changes), pipeline=FAKE) == 2
    assert told in " ".join(capsys.readouterr().out.split())
    assert not (tmp_path / "out").exists()


def test_the_command_line_says_all_there_is_to_say(tmp_path, monkeypatch):
    asked: list[ScanArguments] = []
    monkeypatch.setattr(
        "service.commands.scan.scan_locally", lambda given: asked.append(given) or 0
    )
    command = ["scan", "front.jpg", "side.jpg", "--gender", "male", "--height-m", "1.8"]
    with pytest.raises(SystemExit) as ended:
        main([*command, "--weight-kg", "80", "--points", "a.json", "auto", "--force"])
    assert ended.value.code == 0
    (given,) = asked
    assert given.images == [Path("front.jpg"), Path("side.jpg")]
    assert given.points == [Path("a.json"), None]
    assert given.overrides == {"gender": "male", "height_m": 1.8, "weight_kg": 80, "force": True}
    assert given.of_all_views == {}
