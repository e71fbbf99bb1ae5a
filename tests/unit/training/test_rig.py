import numpy as np
import pytest
from scipy import sparse

from fitter.measurement.plane_cut import Plane, plane_section, whole_mesh
from fitter.numerics.rotations import rotation_matrices
from fitter.training.articulation.parts import PART_NAMES, part_index
from fitter.training.articulation.rig import (
    Rig,
    blend_dual_quaternion,
    blend_linear,
    bone_heads,
    bone_rotations,
    part_weights,
    partial_rotations,
    posed_vertices,
    swing_and_twist,
)
from fitter.training.articulation.rig_drives import bone_drives, rest_axis
from fitter.training.makehuman.body_space import average_traits, source_vertices
from fitter.training.makehuman.meshes import with_knee_rings
from tests.unit.measurement.plain_hull import in_plane
from tests.unit.training.makehuman_data import base_mesh, body_space, needs_makehuman

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


RNG = np.random.default_rng(5)
VECTORS = RNG.normal(scale=1.2, size=(200, 3))
AXES = RNG.normal(size=(200, 3))
AXES /= np.linalg.norm(AXES, axis=1, keepdims=True)


def test_swing_after_twist_gives_the_rotation_back():
    whole = partial_rotations(VECTORS, AXES, np.ones(200), np.ones(200))
    np.testing.assert_allclose(whole, rotation_matrices(VECTORS), atol=1e-9)


def test_a_swing_has_no_part_along_the_twist_axis():
    swing, _ = swing_and_twist(VECTORS, AXES)
    np.testing.assert_allclose(np.einsum("ki,ki->k", swing, AXES), 0.0, atol=1e-9)


def test_a_turn_about_the_axis_is_all_twist():
    draws = np.random.default_rng(6)
    angles = draws.uniform(-3.0, 3.0, 200)
    swing, twist = swing_and_twist(angles[:, None] * AXES, AXES)
    np.testing.assert_allclose(twist, angles, atol=1e-9)
    np.testing.assert_allclose(swing, 0.0, atol=1e-7)


def test_no_share_of_a_rotation_is_no_rotation():
    none = partial_rotations(VECTORS, AXES, np.zeros(200), np.zeros(200))
    np.testing.assert_allclose(none, np.broadcast_to(np.eye(3), (200, 3, 3)), atol=1e-12)


GROUPS = {
    "joint-l-knee": np.array([0]),
    "joint-l-upper-leg": np.array([1]),
    "joint-l-ankle": np.array([2]),
}


def pillar():
    """Three helper points and a leg of rings 1 cm apart, denser in front than behind."""
    front = np.linspace(0.0, np.pi, 60)
    behind = np.linspace(np.pi, 2.0 * np.pi, 20)[1:-1]
    angle = np.concatenate([front, behind])
    circle = np.stack([0.1 + 0.06 * np.cos(angle), 0 * angle, 0.06 * np.sin(angle)], axis=1)
    rings = [circle + [0.0, 0.01 * level, 0.0] for level in range(-20, 21)]
    helpers = np.array([[0.1, 0.003, 0.004], [0.1, 0.4, 0.0], [0.1, -0.4, 0.0]])
    return np.concatenate([helpers, *rings])


def skin_mean(vertices):
    return vertices[3:].mean(axis=0)


def test_the_mean_of_a_ring_is_the_middle_of_the_leg_however_dense_its_mesh():
    vertices = pillar()
    skin = np.arange(3, len(vertices))
    groups = with_knee_rings(GROUPS, vertices, skin, np.arange(len(vertices)))
    ring = vertices[groups["joint-l-knee"]]
    np.testing.assert_allclose(ring[:, 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(ring.mean(axis=0), [0.1, 0.0, 0.0], atol=0.003)
    assert skin_mean(vertices)[2] > 0.015


def test_the_right_ring_is_the_left_ones_mirror_and_other_groups_stay():
    vertices = pillar()
    skin, mirror = np.arange(3, len(vertices)), np.arange(len(vertices))[::-1]
    groups = with_knee_rings(GROUPS, vertices, skin, mirror)
    np.testing.assert_array_equal(groups["joint-r-knee"], mirror[groups["joint-l-knee"]])
    assert groups["joint-l-ankle"] == [2]


@pytest.mark.slow
@needs_makehuman
@pytest.mark.parametrize(("gender", "height"), [("female", 0.2), ("male", 0.8)])
def test_short_and_tall_peoples_knees_are_in_the_middle_of_their_legs(gender: str, height: float):
    space, base = body_space(gender), base_mesh()
    parameters = space.neutral.copy()
    parameters[space.parameter_names.index("height")] = height
    source = source_vertices(space, average_traits(), parameters)
    hip, knee, ankle = (
        source[base.groups[f"joint-l-{name}"]].mean(axis=0)
        for name in ("upper-leg", "knee", "ankle")
    )
    plane = Plane(point=knee, normal=(ankle - hip) / np.linalg.norm(ankle - hip))
    lines = plane_section(base.body(source), whole_mesh(base.triangles), plane)
    leg = in_plane(
        min(lines, key=lambda line: np.linalg.norm(line.points.mean(0) - knee)).points, plane
    )
    low, high = leg.min(axis=0), leg.max(axis=0)
    assert np.abs(low + high).max() / 2 < 0.008
    assert 0.45 < (hip - knee)[1] / (hip - ankle)[1] < 0.56
