import numpy as np
import pytest

from fitter.body.model import SparseRows
from fitter.training.articulation.inner_points import inner_weights, nearest
from fitter.training.makehuman.landmarks import with_rows


def limb(bend: float, thickness: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """Skin of two tubes that meet at a joint, the second bent, and the joint itself."""
    angle = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    circle = thickness * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    down, joint = np.linspace(0.02, 0.2, 8), rng.normal(size=3)
    turned = np.array(
        [
            [1.0, 0.0, 0.0],
            [0.0, np.cos(bend), -np.sin(bend)],
            [0.0, np.sin(bend), np.cos(bend)],
        ]
    )
    upper = [circle + [0.0, 0.0, z] for z in down]
    lower = [(circle - [0.0, 0.0, z]) @ turned.T for z in down]
    return np.concatenate([*upper, *lower]) + joint, joint


def limbs(bends: np.ndarray, seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    drawn = [limb(bend, rng.uniform(0.04, 0.08), rng) for bend in bends]
    return np.stack([skin for skin, _ in drawn]), np.stack([joint for _, joint in drawn])


def error(weights: np.ndarray, skins: np.ndarray, points: np.ndarray) -> float:
    found = np.einsum("c,scx->sx", weights, skins)
    return float(np.linalg.norm(found - points, axis=1).mean())


def test_a_point_fitted_to_bent_limbs_stays_at_the_joint_when_others_bend():
    rest, bent = np.zeros(60), np.random.default_rng(1).uniform(0.0, 2.0, 60)
    straight, posed = limbs(rest, 2), limbs(bent, 3)
    both = inner_weights([straight[0], posed[0]], [straight[1], posed[1]])
    alone = inner_weights([straight[0]], [straight[1]])
    others = limbs(np.random.default_rng(4).uniform(0.0, 2.0, 40), 5)
    assert error(both, *others) < 0.003
    assert error(both, *others) < 0.3 * error(alone, *others)


def test_weights_sum_to_one_so_that_points_go_with_the_body():
    skins, points = limbs(np.zeros(20), 6)
    assert inner_weights([skins], [points]).sum() == pytest.approx(1.0)


def test_the_nearest_vertices_are_taken():
    line = np.stack([np.arange(10.0), np.zeros(10), np.zeros(10)], axis=1)
    assert set(nearest(line, np.array([4.2, 0.0, 0.0]), 3)) == {3, 4, 5}


def test_replaced_rows_leave_the_others_as_they_were():
    landmarks = SparseRows(
        names=("nose", "left_hip", "crown"),
        pointers=np.array([0, 1, 3, 4]),
        indices=np.array([5, 1, 2, 7]),
        weights=np.array([1.0, 0.4, 0.6, 1.0]),
    )
    changed = with_rows(landmarks, {"left_hip": {8: 0.5, 9: 0.25, 3: 0.25}})
    assert changed.names == landmarks.names
    np.testing.assert_array_equal(changed.pointers, [0, 1, 4, 5])
    np.testing.assert_array_equal(changed.indices, [5, 8, 9, 3, 7])
    np.testing.assert_array_equal(changed.weights, [1.0, 0.5, 0.25, 0.25, 1.0])
