"""A template written, read again, and each fault of one."""

import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fitter.errors import MeshFolderError
from fitter.training.articulation.part_tree import PART_NAMES
from fitter.training.own_bodies import template_files
from fitter.training.own_bodies.frame import BODY_FRAME
from fitter.training.own_bodies.template import same_surface
from fitter.training.own_bodies.template_files import read_template, write_starting_folder
from tests.unit.training.own_bodies.bodies_folder import template


@pytest.fixture(scope="module", autouse=True)
def _a_mesh_is_read_once() -> Iterator[None]:
    """Reading takes longest; what is wrong in a mesh is in a file of its own."""
    read = cache(template_files.read_mesh)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            template_files, "read_mesh", lambda path, *, place: read(path.resolve(), place=place)
        )
        yield


@pytest.fixture(scope="module")
def written(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("written")
    write_starting_folder(folder, template())
    return folder


@pytest.fixture
def folder(tmp_path, written) -> Path:
    """The same files under links: a test replaces what it changes."""
    for path in written.iterdir():
        if path.is_file():
            (tmp_path / path.name).symlink_to(path)
    return tmp_path


def replace_text(folder: Path, name: str, text: str) -> None:
    (folder / name).unlink()
    (folder / name).write_text(text)


def describe(folder: Path, changed) -> None:
    description = json.loads((folder / "template.json").read_text())
    changed(description)
    replace_text(folder, "template.json", json.dumps(description))


def edit_mesh(folder: Path, changed) -> None:
    lines = (folder / "template.obj").read_text().splitlines()
    replace_text(folder, "template.obj", "\n".join(changed(lines)) + "\n")


def assert_refused(folder: Path, place: str, *words: str) -> None:
    with pytest.raises(MeshFolderError) as caught:
        read_template(folder, BODY_FRAME)
    assert caught.value.place == place
    for word in words:
        assert word in str(caught.value)
    assert caught.value.remedy


def test_a_written_template_is_read_as_the_same_surface(written):
    before, after = template(), read_template(written, BODY_FRAME)
    np.testing.assert_allclose(after.vertices, before.vertices, atol=1e-7)
    assert same_surface(after.mesh, before.mesh)
    np.testing.assert_array_equal(after.mesh.mirror, before.mesh.mirror)
    assert after.mesh.landmarks.names == before.mesh.landmarks.names
    for name in ("indices", "pointers"):
        for rows in ("joint_regressor", "landmarks"):
            found = getattr(getattr(after.mesh, rows), name)
            np.testing.assert_array_equal(found, getattr(getattr(before.mesh, rows), name))
    np.testing.assert_allclose(
        after.mesh.joint_regressor.weights, before.mesh.joint_regressor.weights, atol=1e-5
    )
    np.testing.assert_allclose(after.mesh.uv, before.mesh.uv, atol=1e-6)
    np.testing.assert_allclose(
        after.mesh.parts.skinning_weights, before.mesh.parts.skinning_weights, atol=1e-6
    )


def test_parts_may_come_in_another_order(folder):
    names = list(reversed(PART_NAMES))
    weights = np.load(folder / "skinning_weights.npy")[:, ::-1]
    given = len(names) - 1 - np.load(folder / "part_of_triangle.npy")
    for name, array in (("skinning_weights.npy", weights), ("part_of_triangle.npy", given)):
        (folder / name).unlink()
        np.save(folder / name, array)
    describe(folder, lambda entries: entries.update(part_names=names))
    assert same_surface(read_template(folder, BODY_FRAME).mesh, template().mesh)


def test_weights_alone_cut_the_mesh_into_nearly_the_same_parts(folder):
    describe(folder, lambda entries: entries.pop("part_of_triangle"))
    found = read_template(folder, BODY_FRAME).mesh.parts.part_of_triangle
    assert (found == template().mesh.parts.part_of_triangle).mean() > 0.99


def test_parts_of_triangles_alone_blend_where_they_meet(folder):
    describe(folder, lambda entries: entries.pop("skinning_weights"))
    parts = read_template(folder, BODY_FRAME).mesh.parts
    np.testing.assert_allclose(parts.skinning_weights.sum(axis=1), 1.0)
    truth = template().mesh.parts
    strongest = parts.skinning_parts[:, 0] == truth.skinning_parts[:, 0]
    assert strongest.mean() > 0.9
    assert 0.05 < (parts.skinning_weights[:, 0] < 0.9).mean() < 0.9


def test_without_a_map_the_mirror_is_the_nearest_vertex_across(folder):
    describe(folder, lambda entries: entries.pop("mirror"))
    found, truth = read_template(folder, BODY_FRAME).mesh.mirror, template().mesh.mirror
    np.testing.assert_array_equal(found[found], np.arange(len(found)))
    assert (found == truth).mean() > 0.95


def test_joints_stand_for_landmarks_that_are_not_given(folder):
    describe(folder, lambda entries: entries["landmarks"].pop("left_knee"))
    mesh = read_template(folder, BODY_FRAME).mesh
    knee, shin = mesh.landmarks.names.index("left_knee"), PART_NAMES.index("left_shin")
    rows, joints = mesh.landmarks, mesh.joint_regressor
    np.testing.assert_array_equal(
        rows.indices[rows.pointers[knee] : rows.pointers[knee + 1]],
        joints.indices[joints.pointers[shin] : joints.pointers[shin + 1]],
    )


def setting(*path: str, value: object):
    def change(entries: dict) -> None:
        for name in path[:-1]:
            entries = entries[name]
        entries[path[-1]] = value

    return change


ENTRIES = {
    "a misspelt entry": (setting("marks", value={}), "template.json: marks", "is not known"),
    "no such mesh": (setting("mesh", value="b.obj"), "template.json: mesh", "names b.obj"),
    "parts missing": (
        setting("part_names", value=["pelvis"]),
        "template.json: part_names",
        "are 1 names, expected these 17",
    ),
    "a short list of parts": (
        setting("part_of_triangle", value=[0, 1]),
        "template.json: part_of_triangle",
        "has shape (2,)",
    ),
    "no such array": (setting("mirror", value="c.npy"), "template.json: mirror", "cannot be read"),
    "fractions": (
        setting("part_of_triangle", value=[0.5]),
        "template.json: part_of_triangle",
        "expected whole numbers",
    ),
    "weights of another shape": (
        setting("skinning_weights", value=[[1.0]]),
        "template.json: skinning_weights",
        "expected (12440, 17)",
    ),
    "a joint beyond the mesh": (
        setting("joints", "head", value=99999),
        "template.json: joints: head",
        "names vertex 99999",
    ),
    "a joint of half a vertex": (
        setting("joints", "head", value=[0.5]),
        "template.json: joints: head",
        "no weighted mean",
    ),
    "weights beyond one": (
        setting("joints", "head", value={"vertices": [1, 2], "weights": [1, 1]}),
        "template.json: joints: head",
        "sum to 2, expected 1",
    ),
    "a mirror that is none": (
        setting("mirror", value=[0, 1]),
        "template.json: mirror",
        "no map of 12440 vertices",
    ),
}


@pytest.mark.parametrize("fault", ENTRIES)
def test_a_wrong_entry_is_named(folder, fault):
    changed, place, words = ENTRIES[fault]
    describe(folder, changed)
    assert_refused(folder, place, words)


def test_all_missing_landmarks_are_named_at_once(folder):
    describe(folder, lambda entries: [entries["landmarks"].pop(n) for n in ("navel", "left_toe")])
    with pytest.raises(MeshFolderError, match=r"A fit needs: .*navel"):
        read_template(folder, BODY_FRAME)


def test_a_missing_joint_is_named(folder):
    describe(folder, lambda entries: entries["joints"].pop("left_upper_arm"))
    assert_refused(folder, "template.json: joints: left_upper_arm", "is missing")


def test_weights_that_are_no_shares_are_named(folder):
    weights = np.load(folder / "skinning_weights.npy")
    weights[11] *= 2.0
    (folder / "skinning_weights.npy").unlink()
    np.save(folder / "skinning_weights.npy", weights)
    assert_refused(folder, "template.json: skinning_weights", "sums to 2 at vertex 11")


def first_face(lines: list[str]) -> int:
    return next(k for k, line in enumerate(lines) if line.startswith("f "))


def without_a_face(lines):
    del lines[first_face(lines)]
    return lines


def with_a_face_twice(lines):
    return [*lines, lines[first_face(lines)]]


def with_a_face_turned(lines):
    place = first_face(lines)
    kind, *corners = lines[place].split()
    lines[place] = " ".join([kind, *reversed(corners)])
    return lines


def inside_out(lines):
    return [
        " ".join(["f", *reversed(line.split()[1:])]) if line.startswith("f ") else line
        for line in lines
    ]


def beyond(lines):
    return [*lines, "f 1 2 99999"]


def without_faces(lines):
    return [line for line in lines if not line.startswith("f ")]


def with_an_idle_vertex(lines):
    return [*lines, "v 0 0 0"]


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        (without_a_face, "has a hole: 3 edges"),
        (with_a_face_twice, "is not manifold"),
        (with_a_face_turned, "is not oriented alike"),
        (inside_out, "inside out"),
        (beyond, "triangles beyond its vertices"),
        (without_faces, "has no triangles"),
        (with_an_idle_vertex, "leaves 1 vertices without a triangle"),
    ],
)
def test_a_mesh_that_is_no_skin_is_refused(folder, changed, words):
    edit_mesh(folder, changed)
    assert_refused(folder, "template.obj", words)
