"""Shoulder, elbow, wrist, hip, knee and ankle as people click them: fitted to posed bodies.

These points lie inside the body, where the rig turns. Fitted at rest alone, their weights put a
bent hip 22 mm from its centre on average: the skin in front folds, the skin behind stretches.
Fitted to subjects at rest and in random poses alike, they choose skin that does neither.
"""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Vertices
from fitter.body.model import SparseRows
from fitter.training.articulation.poses import random_pose
from fitter.training.articulation.rig import bone_heads, bone_rotations, placed_heads
from fitter.training.articulation.rigged_bodies import RegisteredBodies, RiggedMesh
from fitter.training.makehuman.landmarks import Row, with_rows

BONES: Mapping[str, str] = {
    "shoulder": "upperarm01.L",
    "elbow": "lowerarm01.L",
    "wrist": "wrist.L",
    "hip": "upperleg01.L",
    "knee": "lowerleg01.L",
    "ankle": "foot.L",
}
"""The bone about whose head the joint turns."""

EXAMPLES = 240
"""Subjects at rest, and as many posed; on others the error is the same to a tenth."""

CANDIDATES = 400
"""Vertices a point may be a sum of, the nearest to it."""

RIDGE = 3e-4
"""Square metres, on the weights. With a tenth of it a hip comes 1 mm nearer, with weights that sum
to 12 in absolute value in place of 4 and pass on what the model's mesh has wrong."""


def with_inner_points(
    landmarks: SparseRows,
    mesh: RiggedMesh,
    sources: Float[np.ndarray, "s v 3"],
    bodies: RegisteredBodies,
    rng: np.random.Generator,
) -> SparseRows:
    """The landmarks with their inner points fitted to one gender's subjects.

    Parameters
    ----------
    landmarks
        Of the mesh, with all names.
    mesh
        The mesh with the rig that poses it.
    sources, bodies
        All source vertices of the subjects at rest, and the same subjects as registered bodies.
    rng
        Draws their poses.
    """
    # Of few subjects, some are taken more than once, in poses of their own.
    chosen = np.linspace(0, len(sources) - 1, EXAMPLES).astype(int)
    heads = np.stack([bone_heads(mesh.rig, sources[k].astype(np.float64)) for k in chosen])
    poses = [random_pose(rng) for _ in chosen]
    posed = np.stack(
        [
            bodies.posed(int(k), pose).astype(np.float32)
            for k, pose in zip(chosen, poses, strict=True)
        ]
    )
    posed_heads = np.stack(
        [
            placed_heads(mesh.rig, each, bone_rotations(mesh.rig, pose))
            for each, pose in zip(heads, poses, strict=True)
        ]
    )
    rest = bodies.rest[chosen]
    rows: dict[str, Row] = {}
    for name, bone_name in BONES.items():
        bone = mesh.rig.bone_names.index(bone_name)
        middle = heads[:, bone].mean(axis=0)
        members = nearest(rest.mean(axis=0), middle, CANDIDATES)
        weights = inner_weights(
            [rest[:, members], posed[:, members]], [heads[:, bone], posed_heads[:, bone]]
        )
        rows[f"left_{name}"] = dict(zip(members.tolist(), weights.tolist(), strict=True))
        mirrored = mesh.surface.mirror[members]
        rows[f"right_{name}"] = dict(zip(mirrored.tolist(), weights.tolist(), strict=True))
    return with_rows(landmarks, rows)


def nearest(
    vertices: Vertices, point: Float[np.ndarray, "3"], count: int
) -> Integer[np.ndarray, " c"]:
    """The vertices nearest to a point."""
    return np.argsort(np.linalg.norm(vertices - point, axis=1), kind="stable")[:count]


def inner_weights(
    skins: list[Float[np.ndarray, "_ c 3"]], points: list[Float[np.ndarray, "_ 3"]]
) -> Float[np.ndarray, " c"]:
    """Weights w with sum 1 that minimise Σ_sets mean_s |Σ_c w_c x_sc - p_s|² + ridge |w|²."""
    count = skins[0].shape[1]
    system = np.zeros((count + 1, count + 1))
    system[:count, :count] = RIDGE * np.eye(count)
    for skin, point in zip(skins, points, strict=True):
        offsets = (skin - point[:, None]).transpose(0, 2, 1).reshape(-1, count)
        system[:count, :count] += offsets.T @ offsets / len(skin)
    system[:count, count] = system[count, :count] = 1.0
    return np.linalg.solve(system, np.append(np.zeros(count), 1.0))[:count]
