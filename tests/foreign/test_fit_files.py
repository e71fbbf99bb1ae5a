"""A fit's files as strangers read them: bodies over pictures, tapes around the mesh."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
import trimesh
from PIL import Image, ImageDraw
from scipy.spatial import ConvexHull

from tests.foreign.test_overlay import overlap

VIEWS = (0, 1)

OVERLAP = 0.88
"""Of body and segmentation at least: from the side hair, floor between the feet and fingers are a
tenth of the segmentation, and not of the body."""

LEVEL_TAPES = ("waist_girth_navel", "hip_girth")
"""Taken in a level plane, so that a stranger can cut the mesh at the same height."""


def result(files: Path) -> dict:
    return json.loads((files / "fit" / "result.json").read_text())


def drawn(files: Path, number: int) -> np.ndarray:
    """Where trimesh has the body in a picture, painted by Pillow."""
    view = result(files)["views"][number]
    scene = trimesh.load_scene(
        files / "fit" / "views" / str(number) / "body_posed.glb", process=False
    )
    body = scene.to_mesh()
    body.apply_transform(np.linalg.inv(scene.graph.get("upright")[0]))
    camera = view["image_camera"]
    x, y, z = body.vertices.T
    pixels = np.stack(
        [
            camera["centre_x"] - camera["focal_length_px"] * x / z,
            camera["centre_y"] + camera["focal_length_px"] * y / z,
        ],
        axis=1,
    )
    picture = Image.new("L", (camera["width"], camera["height"]))
    painter = ImageDraw.Draw(picture)
    for face in body.faces:
        painter.polygon(pixels[face].ravel().tolist(), fill=255)
    return np.asarray(picture) > 127


@pytest.mark.parametrize("number", VIEWS)
def test_the_body_of_each_view_lies_over_its_own_picture(files: Path, number: int):
    body, folder = drawn(files, number), files / "fit" / "views" / str(number)
    segmented = np.asarray(Image.open(folder / "segmentation.png").convert("L"))
    segmented = cv2.resize(segmented, body.shape[::-1], interpolation=cv2.INTER_NEAREST)
    assert overlap(body, segmented > 127) > OVERLAP
    other = drawn(files, 1 - number)
    assert overlap(body, other) < 0.8, "front and side are not told apart"


@pytest.mark.parametrize("number", VIEWS)
def test_both_readers_of_pictures_find_the_outline_over_the_photograph(files: Path, number: int):
    folder = files / "fit" / "views" / str(number)
    sent = cv2.imread(str(folder / "image"))
    overlay = cv2.imread(str(folder / "overlay.png"))
    assert sent is not None
    assert overlay is not None
    assert overlay.shape == sent.shape
    pillow = np.asarray(Image.open(folder / "overlay.png").convert("RGB"))
    np.testing.assert_array_equal(pillow[:, :, ::-1], overlay)
    changed = (np.abs(overlay.astype(int) - sent.astype(int)) > 40).any(axis=2)
    assert 0.0005 < changed.mean() < 0.2, "an outline, and no other picture"


def test_the_preview_opens(files: Path):
    with Image.open(files / "fit" / "body.png") as picture:
        picture.load()
        assert min(picture.size) > 200


def test_every_tape_is_where_the_stranger_s_mesh_is(files: Path):
    mesh = trimesh.load_mesh(files / "fit" / "body_canonical.glb", process=False)
    low, high = mesh.bounds
    lines = json.loads((files / "fit" / "tapes.json").read_text())["lines"]
    measured = {each["name"] for each in result(files)["measurements"]}
    assert measured - {"weight"} <= set(lines)
    for name, line in lines.items():
        points = np.array(line)
        assert (points >= low - 0.02).all(), name
        assert (points <= high + 0.02).all(), name


@pytest.mark.parametrize("name", LEVEL_TAPES)
def test_a_stranger_who_cuts_the_mesh_measures_the_same_girth(files: Path, name: str):
    mesh = trimesh.load_mesh(files / "fit" / "body_canonical.glb", process=False)
    tape = np.array(json.loads((files / "fit" / "tapes.json").read_text())["lines"][name])
    assert np.ptp(tape[:, 1]) < 1e-3, "the tape is level"
    cut = trimesh.intersections.mesh_plane(mesh, [0.0, 1.0, 0.0], [0.0, tape[:, 1].mean(), 0.0])
    points = cut.reshape(-1, 3)[:, [0, 2]]
    aside = np.abs(tape[:, 0]).max() + 0.01
    trunk = ConvexHull(points[np.abs(points[:, 0]) < aside])
    (value,) = [each["value"] for each in result(files)["measurements"] if each["name"] == name]
    # The perimeter of a hull in the plane is what scipy calls its area.
    assert 100.0 * trunk.area == pytest.approx(value, rel=0.005)


def test_the_body_weighs_what_a_stranger_s_volume_says(files: Path):
    mesh = trimesh.load_mesh(files / "fit" / "body_canonical.glb", process=False)
    assert mesh.is_watertight
    weight = {each["name"]: each["value"] for each in result(files)["measurements"]}["weight"]
    assert 1000.0 * mesh.volume == pytest.approx(weight, rel=1e-4)
