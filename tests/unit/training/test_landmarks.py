import numpy as np
import pytest

from fitter.body.model import SparseRows, regress
from fitter.training.makehuman.body_space import average_traits, source_vertices
from tests.unit.training import makehuman_data
from tests.unit.training.makehuman_data import base_mesh, body_space, needs_makehuman

pytestmark = needs_makehuman


@pytest.fixture(scope="module")
def landmarks() -> SparseRows:
    return makehuman_data.landmarks()


def points(landmarks: SparseRows, gender: str) -> dict[str, np.ndarray]:
    space = body_space(gender)
    vertices = source_vertices(space, average_traits(), space.neutral)
    found = regress(landmarks, base_mesh().body(vertices))
    return dict(zip(landmarks.names, found, strict=True))


def test_every_row_sums_to_one(landmarks: SparseRows):
    sums = np.add.reduceat(landmarks.weights, landmarks.pointers[:-1])
    np.testing.assert_allclose(sums, 1.0, atol=1e-9)


def test_landmarks_do_not_depend_on_where_the_body_stands(landmarks: SparseRows):
    body = base_mesh().body(base_mesh().source_vertices)
    moved = regress(landmarks, body + [1.0, 2.0, 3.0]) - regress(landmarks, body)
    np.testing.assert_allclose(moved, np.broadcast_to([1.0, 2.0, 3.0], moved.shape), atol=1e-9)


@pytest.mark.parametrize("gender", ["female", "male"])
def test_left_and_right_mirror_each_other(landmarks: SparseRows, gender: str):
    found = points(landmarks, gender)
    for name, point in found.items():
        swap = {"left": "right", "right": "left"}
        other = "_".join(swap.get(word, word) for word in name.split("_"))
        np.testing.assert_allclose(found[other] * [-1, 1, 1], point, atol=2e-3)
        if "left" in name:
            assert point[0] > 0.02


@pytest.mark.parametrize("gender", ["female", "male"])
def test_landmarks_stack_as_a_body_does(landmarks: SparseRows, gender: str):
    found = points(landmarks, gender)
    downwards = ["crown", "left_eye", "nose", "chin", "cervicale", "neck", "left_nipple", "navel"]
    downwards += ["crotch", "left_heel", "sole_left"]
    heights = np.array([found[name][1] for name in downwards])
    assert (np.diff(heights) < 0.0).all()
    assert found["navel"][2] > found["seat"][2]
    assert found["left_toe"][2] > found["left_heel"][2]
    assert 0.25 < found["left_acromion"][0] * 2 < 0.45


@pytest.mark.parametrize("gender", ["female", "male"])
def test_the_face_is_where_faces_have_it(landmarks: SparseRows, gender: str):
    found = points(landmarks, gender)
    eyes, mouth = (
        found[f"left_{name}"] - found[f"right_{name}"] for name in ("eye", "mouth_corner")
    )
    assert 0.055 < eyes[0] < 0.07
    assert 0.035 < mouth[0] < eyes[0]
    downwards = ["left_eye", "nose", "left_mouth_corner", "chin"]
    assert (np.diff([found[name][1] for name in downwards]) < -0.01).all()
    backwards = ["nose", "left_mouth_corner", "left_eye", "left_ear", "cervicale"]
    assert (np.diff([found[name][2] for name in backwards]) < -0.005).all()
    assert found["left_ear"][0] > found["left_eye"][0] + 0.03
