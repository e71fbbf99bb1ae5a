import numpy as np
from scipy import sparse

from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.parts import PART_NAMES, part_index
from fitter.training.articulation.rig import (
    Rig,
    bone_heads,
    bone_rotations,
    part_weights,
    posed_vertices,
)
from fitter.training.articulation.rig_drives import bone_drives, rest_axis
from fitter.training.articulation.skinning import blend_dual_quaternion, blend_linear

BONES = {
    "root": "",
    "spine05": "root",
    "spine01": "spine05",
    "clavicle.L": "spine01",
    "upperarm01.L": "clavicle.L",
    "upperarm02.L": "upperarm01.L",
    "lowerarm02.L": "upperarm02.L",
    "wrist.L": "lowerarm02.L",
}


def synthetic_rig(seed: int = 3) -> tuple[Rig, np.ndarray]:
    rng = np.random.default_rng(seed)
    names = tuple(BONES)
    count = 40
    weights = rng.random((count, len(names))) * (rng.random((count, len(names))) < 0.4)
    weights[np.arange(count), np.arange(count) % len(names)] += 0.2
    weights /= weights.sum(axis=1, keepdims=True)
    heads = np.zeros((len(names), count))
    heads[np.arange(len(names)), rng.choice(count, len(names), replace=False)] = 1.0
    rig = Rig(
        bone_names=names,
        bone_parent=np.array([names.index(BONES[n]) if BONES[n] else -1 for n in names]),
        head_rows=sparse.csr_array(heads),
        weights=sparse.csr_array(weights),
        drives=bone_drives(names),
    )
    return rig, rng.normal(size=(count, 3))


def test_the_rest_pose_moves_nothing():
    rig, vertices = synthetic_rig()
    posed = posed_vertices(rig, rig.weights, vertices, bone_heads(rig, vertices), np.zeros((17, 3)))
    np.testing.assert_allclose(posed, vertices, atol=1e-12)


def test_turning_the_root_turns_the_whole_body_rigidly_about_the_root_centre():
    rig, vertices = synthetic_rig()
    heads = bone_heads(rig, vertices)
    pose = np.zeros((17, 3))
    pose[0] = [0.3, -1.1, 0.7]
    rotation = rotation_matrices(pose)[0]
    posed = posed_vertices(rig, rig.weights, vertices, heads, pose)
    expected = (vertices - heads[0]) @ rotation.T + heads[0]
    np.testing.assert_allclose(posed, expected, atol=1e-12)


def test_bones_at_the_end_of_each_part_turn_by_the_whole_turn_of_their_part():
    rig, _ = synthetic_rig()
    pose = np.random.default_rng(0).normal(scale=0.5, size=(17, 3))
    local = rotation_matrices(pose)
    chest = local[0] @ local[part_index("spine")] @ local[part_index("chest")]
    arm = chest @ local[part_index("left_upper_arm")]
    hand = arm @ local[part_index("left_forearm")] @ local[part_index("left_hand")]
    rotations = bone_rotations(rig, pose)
    for bone, expected in (("spine01", chest), ("upperarm02.L", arm), ("wrist.L", hand)):
        np.testing.assert_allclose(rotations[rig.bone_names.index(bone)], expected, atol=1e-12)


def test_the_collar_bone_takes_a_share_of_the_arms_swing_but_none_of_its_twist():
    rig, _ = synthetic_rig()
    collar = rig.bone_names.index("clavicle.L")
    pose = np.zeros((17, 3))
    pose[part_index("left_upper_arm")] = 0.8 * rest_axis("left_upper_arm")
    np.testing.assert_allclose(bone_rotations(rig, pose)[collar], np.eye(3), atol=1e-12)
    across = np.cross(rest_axis("left_upper_arm"), [0.0, 0.0, 1.0])
    pose[part_index("left_upper_arm")] = across / np.linalg.norm(across)
    expected = rotation_matrices(rig.drives.beyond_swing[collar] * pose[[5]])[0]
    np.testing.assert_allclose(bone_rotations(rig, pose)[collar], expected, atol=1e-12)


def test_part_weights_of_every_vertex_sum_to_one():
    rig, _ = synthetic_rig()
    weights = part_weights(rig, rig.weights)
    assert weights.shape == (40, len(PART_NAMES))
    np.testing.assert_allclose(weights.sum(axis=1), 1.0)


def test_dual_quaternions_keep_a_twisted_limb_from_collapsing():
    # Half way along a limb twisted by 170 degrees, a linear blend shrinks the radius to
    # cos(85 degrees); the blend of dual quaternions keeps it.
    rotations = rotation_matrices(np.array([[0.0, 0.0, 0.0], [np.radians(170.0), 0.0, 0.0]]))
    skin = sparse.csr_array(np.array([[0.5, 0.5]]))
    rest = np.array([[0.4, 0.1, 0.0]])
    still = np.zeros((2, 3))
    linear = blend_linear(skin, rotations, still, rest)
    dual = blend_dual_quaternion(skin, rotations, still, rest)
    np.testing.assert_allclose(
        np.linalg.norm(linear[0, 1:]), 0.1 * np.cos(np.radians(85)), rtol=1e-9
    )
    np.testing.assert_allclose(np.linalg.norm(dual[0, 1:]), 0.1, rtol=1e-9)
    np.testing.assert_allclose(dual[0, 0], 0.4, rtol=1e-9)


def test_both_blends_follow_a_single_bone_rigidly():
    rng = np.random.default_rng(1)
    rotations = rotation_matrices(rng.normal(size=(3, 3)))
    translations = rng.normal(size=(3, 3))
    skin = sparse.csr_array(np.eye(3))
    rest = rng.normal(size=(3, 3))
    expected = np.einsum("bij,bj->bi", rotations, rest) + translations
    for blend in (blend_linear, blend_dual_quaternion):
        np.testing.assert_allclose(blend(skin, rotations, translations, rest), expected, atol=1e-12)
