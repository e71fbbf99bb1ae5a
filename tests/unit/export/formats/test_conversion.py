"""From bytes to bytes: the same again, the version raised where they change."""

import hashlib
import subprocess
import sys

import numpy as np

from fitter.export.formats import FORMATS, ShownBody, Texture, converted, obj_file
from service.representation.formats import MESH_FORMATS, MTL, WRITER_VERSION
from tests.unit.export.formats.bodies import coloured, textured

TRIANGLE = ShownBody(
    name="body",
    generator="a test",
    vertices=np.eye(3),
    normals=np.full((3, 3), 0.57735),
    triangles=np.array([[0, 1, 2]]),
    colours=np.full((3, 3), 0.2),
    colour=np.full(3, 0.2),
    roughness=0.5,
    texture=Texture(
        picture=b"",
        media_type="image/png",
        texels=np.eye(2),
        triangles=np.array([[0, 1, 0]]),
    ),
)
WRITTEN = {1: "a442049d4e77613e"}
"""Digests of the triangle's OBJ by the writer's versions."""


def test_what_the_service_offers_is_what_can_be_written():
    assert set(MESH_FORMATS) | {MTL.ending} == set(FORMATS)


def test_other_bytes_than_before_need_a_new_version():
    digest = hashlib.sha256(obj_file(TRIANGLE)).hexdigest()[:16]
    assert WRITTEN[WRITER_VERSION] == digest, "raise WRITER_VERSION, and add its digest"


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
