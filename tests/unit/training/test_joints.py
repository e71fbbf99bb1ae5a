import numpy as np

from fitter.training.articulation.joints import (
    fit_joint_regressor,
    joint_errors_mm,
    joint_rows_of_bones,
    regressed_joints,
)
from fitter.training.articulation.parts import PART_NAMES, mirrored_part, part_index

RNG = np.random.default_rng(8)
MIRROR_JOINT = np.array([part_index(mirrored_part(name)) for name in PART_NAMES])


def symmetric_bodies(subjects=60, half=150):
    """Clouds with exact mirror pairs, and joints that are convex sums of nearby vertices."""
    left = RNG.uniform([0.02, -0.3, -0.3], [0.6, 0.3, 0.3], size=(half, 3))
    flip = np.array([-1.0, 1.0, 1.0])
    mean = np.concatenate([left, left * flip])
    mirror = np.concatenate([np.arange(half) + half, np.arange(half)])
    moves = RNG.normal(scale=0.05, size=(subjects, half, 3))
    meshes = mean + np.concatenate([moves, moves * flip], axis=1)
    planted = np.zeros((len(PART_NAMES), 2 * half))
    for part, name in enumerate(PART_NAMES):
        if name.startswith("right"):
            continue
        anchor = left[RNG.integers(half)]
        near = np.argsort(np.linalg.norm(mean - anchor, axis=1))[:12]
        planted[part, near] += 1.0 / 12.0
        if mirrored_part(name) == name:
            planted[part] = 0.5 * (planted[part] + planted[part, mirror])
    for part, name in enumerate(PART_NAMES):
        if name.startswith("right"):
            planted[part] = planted[MIRROR_JOINT[part], mirror]
    return meshes, np.einsum("pm,smc->spc", planted, meshes), mirror


def test_planted_joints_are_found_on_bodies_not_trained_on():
    meshes, joints, mirror = symmetric_bodies()
    regressor = fit_joint_regressor(meshes[:40], joints[:40], mirror, MIRROR_JOINT)
    sided = [part for part, name in enumerate(PART_NAMES) if "_" in name]
    assert joint_errors_mm(regressor, meshes[40:], joints[40:])[sided].max() < 10.0


def test_weights_are_positive_and_sum_to_one():
    meshes, joints, mirror = symmetric_bodies()
    regressor = fit_joint_regressor(meshes, joints, mirror, MIRROR_JOINT)
    assert (regressor.weights > 0).all()
    sums = np.add.reduceat(regressor.weights, regressor.pointers[:-1])
    np.testing.assert_allclose(sums, 1.0)


def test_a_mirrored_body_has_mirrored_joints():
    meshes, joints, mirror = symmetric_bodies()
    regressor = fit_joint_regressor(meshes, joints, mirror, MIRROR_JOINT)
    body = RNG.normal(size=meshes[0].shape)
    flip = np.array([-1.0, 1.0, 1.0])
    reflected = np.empty_like(body)
    reflected[mirror] = body * flip
    found = regressed_joints(regressor, np.stack([body, reflected]))
    np.testing.assert_allclose(found[1, MIRROR_JOINT], found[0] * flip, atol=1e-12)


def test_every_joint_is_a_mean_of_bone_centres():
    bones = ("upperarm01", "lowerarm01", "wrist", "upperleg01", "lowerleg01", "foot")
    names = tuple(f"{bone}.{side}" for bone in bones for side in "LR")
    names += ("spine05", "spine04", "spine03", "spine02", "spine01")
    names += ("neck01", "neck02", "neck03", "head")
    np.testing.assert_allclose(joint_rows_of_bones(names).sum(axis=1), 1.0)
