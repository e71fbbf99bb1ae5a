"""assimp, which many programs read glTF with, opens every mesh file."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.foreign.artifacts import GLB_FILES
from tests.foreign.expected import shown_by


@pytest.fixture(scope="module")
def assimp() -> str:
    path = shutil.which("assimp")
    if path is None:
        if os.environ.get("CI"):
            pytest.fail("assimp is not installed: apt-get install assimp-utils")
        pytest.skip("assimp is not installed (Debian's assimp-utils)")
    return path


@pytest.mark.parametrize("name", GLB_FILES)
def test_assimp_finds_body_and_camera(files: Path, assimp: str, name: str):
    shown = shown_by(name, files)
    done = subprocess.run(
        [assimp, "info", str(files / name)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout
    told = dict(re.findall(r"^(\w+(?: \w+)?):? +(\d+|\(.*\))$", done.stdout, re.MULTILINE))
    assert (int(told["Vertices"]), int(told["Faces"])) == (shown.vertices, shown.triangles)
    # It counts lights that no node switches on: those are not compared.
    assert int(told["Cameras"]) == shown.cameras
    assert int(told["Animations"]) == (len(shown.frames) > 1)
    if len(shown.frames) == 1:
        low, high = (
            [float(x) for x in told[key].strip("() ").split()]
            for key in ("Minimum point", "Maximum point")
        )
        assert shown.agrees(low, high)
