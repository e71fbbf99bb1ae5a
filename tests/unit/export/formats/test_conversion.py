"""From bytes to bytes, the same again."""

import subprocess
import sys

from fitter.export.formats import FORMATS, converted
from service.api.files import MATERIAL, MESH_FORMATS
from tests.unit.export.formats.bodies import coloured, textured


def test_what_the_service_offers_is_what_can_be_written():
    assert set(MESH_FORMATS) | set(MATERIAL) == set(FORMATS)


def test_another_process_writes_the_same_bytes(tmp_path):
    (tmp_path / "coloured.glb").write_bytes(coloured().glb)
    (tmp_path / "textured.glb").write_bytes(textured().glb)
    program = """
import hashlib, sys
from pathlib import Path
from fitter.export.formats import FORMATS, converted
for name in ("coloured", "textured"):
    glb = (Path(sys.argv[1]) / f"{name}.glb").read_bytes()
    for ending in FORMATS:
        if (name, ending) != ("coloured", "mtl"):
            print(hashlib.sha256(converted(glb, ending)).hexdigest())
"""
    runs = [
        subprocess.run(
            [sys.executable, "-c", program, str(tmp_path)],
            env={"PYTHONHASHSEED": seed, "PYTHONPATH": ":".join(sys.path)},
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        for seed in ("1", "2")
    ]
    assert runs[0] == runs[1]
    assert len(set(runs[0])) == 7


def test_a_material_is_that_of_a_texture():
    assert b"map_Kd texture.png" in converted(textured().glb, "mtl")
