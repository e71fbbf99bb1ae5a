"""Blender's own importer brings in every mesh file, with camera, skin and morph targets.

Blender comes as the package bpy (350 MB, for one version of Python), in an environment of its own.
"""

import json
import os
import subprocess
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from tests.foreign.artifacts import GLB_FILES
from tests.foreign.expected import shown_by

ROOT = Path(__file__).parents[2]
BLENDER = ROOT / ".venv-blender" / "bin" / "python"


@pytest.fixture(scope="module")
def imported(files: Path) -> Mapping[str, dict[str, Any]]:
    """What Blender says of every file, by its name."""
    if not BLENDER.exists():
        if os.environ.get("CI"):
            pytest.fail("run `make blender` first")
        pytest.skip("Blender is not installed (`make blender`, 350 MB)")
    script = Path(__file__).parent / "readers" / "blender.py"
    # Blender brings modules of its own: those of the tests are none of its business.
    environment = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    done = subprocess.run(
        [str(BLENDER), str(script), *(str(files / name) for name in GLB_FILES)],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    told = [line.removeprefix("SEEN ") for line in done.stdout.splitlines() if line[:5] == "SEEN "]
    return {name: json.loads(each) for name, each in zip(GLB_FILES, told, strict=True)}


@pytest.mark.parametrize("name", GLB_FILES)
def test_blender_imports_the_body(files: Path, imported: Mapping[str, dict[str, Any]], name: str):
    shown = shown_by(name, files)
    told = imported[name]
    counts = ("vertices", "triangles", "cameras", "bones", "morph_targets")
    assert [told[each] for each in counts] == [getattr(shown, each) for each in counts]
    assert told["lights"] == 0
    assert told["textures"] == shown.texture
    assert told["extras"].startswith("metres")
    assert len(told["frames"]) == len(shown.frames)
    for frame, box in enumerate(told["frames"]):
        assert shown.agrees(*in_file_axes(box), frame=frame)


def in_file_axes(box: list[list[float]]) -> tuple[list[float], list[float]]:
    """From Blender's axes (x, -z, y) back to the file's."""
    (x0, y0, z0), (x1, y1, z1) = box
    return [x0, z0, -y1], [x1, z1, -y0]
