"""Ellipsoidal people of 17 parts: everything training needs, with known answers."""

import numpy as np
import trimesh
from scipy import sparse

from fitter.body.model import SparseRows, global_rotations, posed_joints
from fitter.training.articulation.parts import (
    PART_NAMES,
    PART_PARENT,
    mirrored_part,
    part_index,
)
from fitter.training.articulation.rig import blend_linear
from fitter.training.articulation.rigged_bodies import RegisteredBodies
from fitter.training.makehuman.meshes import BaseMesh

SPHERE = trimesh.creation.icosphere(subdivisions=3)
MEAN = np.asarray(SPHERE.vertices) * [0.3, 0.9, 0.2]
TRIANGLES = np.asarray(SPHERE.faces, dtype=np.int32)
FLIP = np.array([-1.0, 1.0, 1.0])
MIRROR = np.argmin(
    np.linalg.norm((MEAN * FLIP)[:, None] - MEAN[None], axis=2), axis=1
)  # exact: the icosphere is symmetric
PLANTED = 20


def surface() -> BaseMesh:
    return BaseMesh(
        source_vertices=MEAN,
        groups={},
        body_vertex_ids=np.arange(len(MEAN)),
        triangles=TRIANGLES,
        uv=MEAN[:, :2],
        uv_triangles=TRIANGLES,
        mirror=MIRROR,
        cap_triangles=np.zeros(0, dtype=np.int32),
    )


def part_weights() -> np.ndarray:
    """Seventeen blobs, mirrored in pairs."""
    rng = np.random.default_rng(4)  # a seed that leaves every part some triangles
    centres = MEAN[rng.choice(len(MEAN), len(PART_NAMES), replace=False)].copy()
    for part, name in enumerate(PART_NAMES):
        other = part_index(mirrored_part(name))
        if other == part:
            centres[part, 0] = 0.0
        elif name.startswith("right"):
            centres[part] = centres[other] * FLIP
    closeness = -(np.linalg.norm(MEAN[:, None] - centres[None], axis=2) ** 2) / 0.01
    weights = np.exp(closeness - closeness.max(axis=1, keepdims=True))
    return weights / weights.sum(axis=1, keepdims=True)


def landmarks() -> SparseRows:
    low = int(np.argmin(MEAN[:, 1]))
    return SparseRows(
        names=("crown", "sole_left", "sole_right"),
        pointers=np.arange(4),
        indices=np.array([int(np.argmax(MEAN[:, 1])), low, low]),
        weights=np.ones(3),
    )


def population(subjects: int, seed: int, *, axes: int = PLANTED) -> RegisteredBodies:
    """Bodies with smooth planted displacements, the first of which makes them taller."""
    rng = np.random.default_rng(100)
    waves = rng.normal(size=(axes, 3)) * 3.0
    fields = np.sin(MEAN @ waves.T + rng.uniform(0, 6, axes)).T[..., None] * rng.normal(
        scale=0.02, size=(axes, 1, 3)
    )
    fields[..., 1] = 0.0
    fields[0] = MEAN * [0.01, 0.04, 0.01]
    coefficients = np.random.default_rng(seed).normal(size=(subjects, axes))
    rest = MEAN + np.tensordot(coefficients, fields, axes=1)
    weights = part_weights()
    near = (weights / weights.sum(axis=0)).T
    joints = np.einsum("pm,smc->spc", near, rest)
    skin = sparse.csr_array(weights)

    def posed(subject, pose):
        rotations = global_rotations(pose, PART_PARENT)
        centres = posed_joints(joints[subject], rotations, PART_PARENT)
        translations = centres - np.einsum("pij,pj->pi", rotations, joints[subject])
        return blend_linear(skin, rotations, translations, rest[subject])

    return RegisteredBodies(rest=rest, joints=joints, posed=posed)
