"""glTF Transform's inspector sees every body, and how large it is."""

import csv
import subprocess
from pathlib import Path

import pytest

from tests.foreign.artifacts import GLB_FILES
from tests.foreign.expected import Shown, shown_by

PRINTED_M = 1e-5
"""It prints five decimals."""


# It is started anew for each, and a scan's files differ from a fit's in what the bodies are like.
OF_A_FIT = [name for name in GLB_FILES if not name.startswith("scan")]


@pytest.mark.parametrize("name", OF_A_FIT)
def test_inspect_finds_one_scene_with_the_body_in_it(files: Path, npm_readers: Path, name: str):
    shown = shown_by(name, files)
    tables = inspected(npm_readers, files / name)
    (scene,) = tables["SCENES"]
    (mesh,) = tables["MESHES"]
    assert int(mesh["vertices"]) == shown.vertices
    assert int(mesh["glPrimitives"]) == shown.triangles
    assert mesh["instances"] == "1"
    low, high = ([float(x) for x in scene[key].split(",")] for key in ("bboxMin", "bboxMax"))
    if shown.bones == 0:
        # It measures what stands in the file: of morph targets the first frame, of a skin the
        # pose it is bound in.
        assert widened(shown).agrees(low, high)
    assert low[1] == pytest.approx(0.0, abs=0.01) or shown.cameras
    assert len(tables.get("ANIMATIONS", ())) == (len(shown.frames) > 1)
    assert len(tables.get("TEXTURES", ())) == shown.texture


def widened(shown: Shown) -> Shown:
    return Shown(
        frames=shown.frames,
        vertices=shown.vertices,
        triangles=shown.triangles,
        tolerance_m=shown.tolerance_m + PRINTED_M,
    )


def inspected(npm_readers: Path, file: Path) -> dict[str, list[dict[str, str]]]:
    """The tables it prints, by heading."""
    command = ["node_modules/.bin/gltf-transform", "inspect", "--format", "csv", str(file)]
    done = subprocess.run(command, cwd=npm_readers, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    tables: dict[str, list[str]] = {}
    heading = ""
    for line in done.stdout.splitlines():
        if line.strip().isupper() and "," not in line:
            heading = line.strip()
            tables[heading] = []
        elif "," in line:
            tables[heading].append(line)
    return {name: list(csv.DictReader(lines)) for name, lines in tables.items()}
