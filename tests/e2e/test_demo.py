"""``maquette demo`` as a user starts it: the second command of the README."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from api_schemas.results import FitResult
from service.demo_data.sample import load_sample
from tests.e2e.service import FIT_WITHIN_S, REPOSITORY

PROMISED = {
    "body_canonical.glb",
    "body.png",
    "result.json",
    "views/0/body_posed.glb",
    "views/0/segmentation.png",
    "views/0/trimap.png",
    "views/0/overlay.png",
    "views/0/albedo.png",
    "views/0/shading.png",
}


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    """What the demo printed, and its output folder."""
    output = tmp_path_factory.mktemp("demo") / "demo-output"
    finished = subprocess.run(
        [sys.executable, "-m", "service.cli", "demo", "--output", str(output)],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
        timeout=FIT_WITHIN_S,
        check=False,
    )
    log = output / "service.log"
    assert finished.returncode == 0, finished.stdout + finished.stderr + log.read_text()
    return finished.stdout, output


@pytest.fixture(scope="module")
def result(demo: tuple[str, Path]) -> FitResult:
    return FitResult.model_validate_json((demo[1] / "result.json").read_bytes())


def test_the_promised_files_lie_in_the_output_folder(demo: tuple[str, Path]):
    _, output = demo
    assert {str(path.relative_to(output)) for path in output.rglob("*")} >= PROMISED
    assert (output / "views/0/body_posed.glb").read_bytes()[:4] == b"glTF"
    assert (output / "views/0/overlay.png").read_bytes()[:4] == b"\x89PNG"


def test_every_true_measurement_is_printed_beside_what_was_found(
    demo: tuple[str, Path], result: FitResult
):
    printed, _ = demo
    truth = load_sample().truth
    found = {measurement.name: measurement.value for measurement in result.measurements}
    assert set(truth) <= set(found)
    for name, true in truth.items():
        begin = f"{name.replace('_', ' ')}, "
        row = next(line for line in printed.splitlines() if line.startswith(begin))
        numbers = [float(number) for number in re.findall(r"[-+]?\d+\.\d", row)]
        assert numbers[-2] == pytest.approx(true, abs=0.051)
        assert numbers[-1] == pytest.approx(found[name] - true, abs=0.051)


def test_the_bars_name_every_stage_that_took_time(demo: tuple[str, Path], result: FitResult):
    printed, _ = demo
    for stage in result.stage_seconds:
        if stage != "export":
            assert stage.replace("_", " ") in printed


def test_no_point_and_no_picture_is_in_the_log(demo: tuple[str, Path]):
    log = (demo[1] / "service.log").read_text()
    (view,) = json.loads(load_sample().request)["views"]
    assert not any(str(point["x"]) in log for point in view["points"].values())
