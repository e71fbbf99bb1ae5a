"""A template written, read again, and each fault of one."""

from pathlib import Path

import numpy as np
import pytest

from fitter.body.model import regress
from fitter.errors import MeshFolderError
from fitter.training.own_bodies.template import (
    TEMPLATE_FILE,
    nearest_mirror,
    read_template,
    same_surface,
    write_template,
)
from tests.unit.training.own_bodies.bodies_folder import template


@pytest.fixture(scope="module")
def written(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("written") / TEMPLATE_FILE
    write_template(path, template())
    return path


@pytest.fixture(scope="module")
def arrays(written) -> dict[str, np.ndarray]:
    with np.load(written) as archive:
        return dict(archive)


def refused(tmp_path: Path, arrays: dict[str, np.ndarray], **changed) -> MeshFolderError:
    """The error of a file with some arrays changed, or left out by None."""
    kept = {name: array for name, array in (arrays | changed).items() if array is not None}
    np.savez(tmp_path / TEMPLATE_FILE, **kept)
    with pytest.raises(MeshFolderError) as caught:
        read_template(tmp_path / TEMPLATE_FILE)
    assert caught.value.remedy
    return caught.value


def test_a_written_template_is_read_as_the_same_surface(written):
    before, after = template(), read_template(written)
    np.testing.assert_array_equal(after.vertices, before.vertices)
    assert same_surface(after.mesh, before.mesh)
    assert after.mesh.landmarks.names == before.mesh.landmarks.names
    for rows in ("joint_regressor", "landmarks"):
        found, true = (
            regress(getattr(each.mesh, rows), before.vertices) for each in (after, before)
        )
        np.testing.assert_allclose(found, true, atol=1e-5)
    np.testing.assert_array_equal(after.mesh.uv, before.mesh.uv)
    np.testing.assert_allclose(
        after.mesh.parts.skinning_weights, before.mesh.parts.skinning_weights, atol=1e-6
    )


def test_the_mirror_is_the_nearest_vertex_across():
    found, truth = nearest_mirror(template().vertices), template().mesh.mirror
    np.testing.assert_array_equal(found[found], np.arange(len(found)))
    assert (found == truth).mean() > 0.95


ARRAYS = {
    "a missing array": ("joints", lambda _: None, "is missing"),
    "fractions": ("part_of_triangle", lambda a: a + 0.5, "holds float64"),
    "a short list of parts": ("part_of_triangle", lambda a: a[:2], "has shape (2,)"),
    "a part without skin": ("part_of_triangle", lambda a: np.maximum(a, 1), "each of pelvis"),
    "weights of another shape": ("skinning_weights", lambda a: a[:, :3], "expected (12440, 17)"),
    "weights that are no shares": ("skinning_weights", lambda a: 2.0 * a, "sums to 2 at vertex"),
    "rows that do not sum to one": ("joints", lambda a: 2.0 * a, "weigh pelvis by 2 in all"),
    "landmarks without a name": ("landmark_names", lambda a: a[1:], "expected (38, 12440)"),
    "triangles beyond the mesh": ("triangles", lambda a: a + 1, "beyond the 12440 vertices"),
    "inside out": ("triangles", lambda a: a[:, ::-1], "inside out"),
}


@pytest.mark.parametrize("fault", ARRAYS)
def test_a_wrong_array_is_named(tmp_path, arrays, fault):
    name, changed, words = ARRAYS[fault]
    error = refused(tmp_path, arrays, **{name: changed(arrays[name])})
    assert words in str(error)
    assert error.place.startswith(f"{TEMPLATE_FILE}: ")


def test_all_missing_landmarks_are_named_at_once(tmp_path, arrays):
    kept = ~np.isin(arrays["landmark_names"], ["navel", "left_toe"])
    changed = {name: arrays[name][kept] for name in ("landmark_names", "landmarks")}
    error = refused(tmp_path, arrays, **changed)
    assert error.place == f"{TEMPLATE_FILE}: landmark_names"
    assert "left_toe" in error.reason
    assert "navel" in error.reason


def test_a_file_that_is_no_archive_is_named(tmp_path):
    (tmp_path / TEMPLATE_FILE).write_text("PK")
    with pytest.raises(MeshFolderError, match="cannot be read"):
        read_template(tmp_path / TEMPLATE_FILE)
