"""Bone centres told by the skin around them, on MakeHuman's bodies."""

from functools import cache

import numpy as np
import pytest

from fitter.body.model import SparseRows
from fitter.training.articulation import bone_centres
from fitter.training.articulation.bone_centres import (
    inner_weights,
    nearest,
    turning_bones,
    with_skin_centres,
)
from fitter.training.articulation.rig import Rig, bone_heads
from fitter.training.makehuman.landmarks import with_rows
from tests.unit.training.makehuman_data import base_mesh, body_space, needs_makehuman
from tests.unit.training.rigged_neutral import neutral_source, rig

pytestmark = needs_makehuman

FEW = 40
"""Bodies that the centres are fitted on here."""


@cache
def fitted() -> Rig:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bone_centres, "SAMPLES", FEW)
        return with_skin_centres(rig(), base_mesh(), body_space("female"))


def names() -> list[str]:
    return [rig().bone_names[bone] for bone in turning_bones(rig())]


def bone(name: str) -> int:
    return rig().bone_names.index(name)


def test_limbs_and_trunk_turn_and_fingers_toes_and_face_do_not():
    assert {"root", "upperarm01.L", "lowerarm01.R", "upperleg01.L", "foot.R"} <= set(names())
    assert not any(name.startswith(("finger", "toe", "eye", "jaw")) for name in names())


def test_centres_are_weighted_means_of_the_body_alone():
    rows = fitted().head_rows.toarray()[turning_bones(rig())]
    helpers = np.setdiff1d(np.arange(rows.shape[1]), base_mesh().body_vertex_ids)
    assert (rows >= 0.0).all()
    np.testing.assert_allclose(rows.sum(axis=1), 1.0, atol=1e-9)
    assert len(helpers) > 1000
    assert not rows[:, helpers].any()


def test_centres_come_near_the_cubes_of_the_rig():
    found, cubes = (bone_heads(each, neutral_source()) for each in (fitted(), rig()))
    distances_mm = 1000.0 * np.linalg.norm(found - cubes, axis=1)
    assert distances_mm[turning_bones(rig())].mean() < 12.0
    for name in ("upperleg01.L", "lowerleg01.L", "lowerarm01.L", "wrist.L"):
        assert distances_mm[bone(name)] < 8.0


def test_bones_that_do_not_turn_keep_their_cubes():
    others = np.setdiff1d(np.arange(len(rig().bone_names)), turning_bones(rig()))
    assert len(others) > 20
    assert abs(fitted().head_rows[others] - rig().head_rows[others]).max() == 0.0


def test_bones_within_a_limb_lie_on_the_line_between_its_ends():
    heads = bone_heads(fitted(), neutral_source())
    for middle, first, last in (
        ("upperarm02", "upperarm01", "lowerarm01"),
        ("lowerleg02", "lowerleg01", "foot"),
    ):
        start, end, point = (heads[bone(f"{name}.R")] for name in (first, last, middle))
        way = (end - start) / np.linalg.norm(end - start)
        along = (point - start) @ way
        assert 0.0 < along < np.linalg.norm(end - start)
        np.testing.assert_allclose(point, start + along * way, atol=1e-6)


def test_right_bones_mirror_left_ones_and_the_spine_lies_in_the_middle():
    base, symmetric = base_mesh(), neutral_source().copy()
    body = base.body(symmetric)
    mirrored = body[base.mirror] * [-1.0, 1.0, 1.0]
    symmetric[base.body_vertex_ids] = 0.5 * (body + mirrored)
    heads = bone_heads(fitted(), symmetric)
    for name in names():
        stem, _, side = name.partition(".")
        if side == "L":
            mirrored = heads[bone(f"{stem}.R")] * [-1.0, 1.0, 1.0]
            np.testing.assert_allclose(heads[bone(name)], mirrored, atol=1e-6)
        elif not side:
            assert abs(heads[bone(name), 0]) < 1e-6


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
