"""A small articulated body with every field of a real model: a bar of three parts."""

import numpy as np

from fitter.body.model import BodyModel, LighterMesh, SparseRows
from fitter.numerics.meshes import gradient_operator


def undecimated(triangles: np.ndarray, count: int) -> LighterMesh:
    """All of a mesh of so many vertices."""
    return LighterMesh(
        kept=np.arange(count),
        triangles=triangles,
        origin=np.arange(len(triangles)),
        corners=np.repeat(np.arange(count)[:, None], 3, axis=1),
        shares=np.tile([1.0, 0.0, 0.0], (count, 1)),
    )


def bar_model(*, seed: int = 0, rings: int = 13, sides: int = 8) -> BodyModel:
    """A closed bar along y, 1.2 m high, bent at two joints, with two shape axes.

    The top is driven by the whole and by half of its own turn (joint 2 and 3 + 2).
    """
    rng = np.random.default_rng(seed)
    y = np.linspace(0.0, 1.2, rings)
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([0.1 * np.sin(angle), np.zeros(sides), 0.1 * np.cos(angle)], axis=1)
    tube = np.concatenate([ring + [0, height, 0] for height in y])
    vertices = np.concatenate([tube, [[0, -0.05, 0], [0, 1.25, 0]]])
    triangles = []
    for row in range(rings - 1):
        for side in range(sides):
            a, b = row * sides + side, row * sides + (side + 1) % sides
            triangles += [[a, b, b + sides], [a, b + sides, a + sides]]
    bottom, top = len(tube), len(tube) + 1
    for side in range(sides):
        after = (side + 1) % sides
        last = (rings - 1) * sides
        triangles += [[bottom, after, side], [top, last + side, last + after]]
    triangles = np.array(triangles, dtype=np.int32)
    centre = vertices[triangles].mean(axis=1)[:, 1]
    part_of_triangle = np.digitize(centre, [0.4, 0.8]).astype(np.int32)
    gradient = gradient_operator(vertices, triangles)
    area = 0.5 * np.linalg.norm(
        np.cross(
            vertices[triangles[:, 1]] - vertices[triangles[:, 0]],
            vertices[triangles[:, 2]] - vertices[triangles[:, 0]],
        ),
        axis=1,
    )
    touched = [np.unique(triangles[part_of_triangle == part]) for part in range(3)]
    q = 2
    blocks = []
    for part in range(3):
        weights = np.repeat(np.where(part_of_triangle == part, area, 0.0), 2)
        term = 0.05 * rng.standard_normal((2 * len(triangles), 3 * 9 * q))
        blocks.append((gradient.T @ (weights[:, None] * term))[touched[part]])
    smooth = vertices - vertices.mean(axis=0)
    basis = np.stack([smooth * [0.0, 0.05, 0.0], smooth * [0.3, 0.0, 0.2]])
    weight_parts = np.clip((vertices[:, 1] / 1.2) * 3, 0, 2.999).astype(np.int32)
    skinning_parts = np.repeat(weight_parts[:, None], 4, axis=1)
    skinning_weights = np.tile([1.0, 0.0, 0.0, 0.0], (len(vertices), 1))
    at = [0, sides * 4, sides * 8]
    count = len(vertices)
    return BodyModel(
        gender="female",
        header={},
        triangles=triangles,
        mean_vertices=vertices,
        shape_basis=basis,
        part_names=("bottom", "middle", "top"),
        part_parent=np.array([-1, 0, 1], dtype=np.int32),
        part_of_triangle=part_of_triangle,
        triangle_weights=area,
        joint_regressor=SparseRows(
            names=("bottom", "middle", "top"),
            pointers=np.arange(4) * sides,
            indices=np.concatenate([np.arange(s, s + sides) for s in at]),
            weights=np.full(3 * sides, 1.0 / sides),
        ),
        skinning_parts=skinning_parts,
        skinning_weights=skinning_weights,
        pose_feature_joints=np.array([[1, -1], [1, 2], [2, 5]], dtype=np.int32),
        pose_feature_strengths=0.3 * rng.standard_normal((3, 9 * q, 2)),
        incidence_pointers=np.cumsum([0] + [len(t) for t in touched]).astype(np.int32),
        incidence_vertices=np.concatenate(touched).astype(np.int32),
        pose_right_hand_sides=np.concatenate(blocks).reshape(-1, 3, 9 * q).astype(np.float32),
        landmarks=SparseRows(
            names=("crown", "sole_left", "sole_right"),
            pointers=np.array([0, 1, 2, 3]),
            indices=np.array([count - 1, count - 2, count - 2]),
            weights=np.ones(3),
        ),
        uv=np.zeros((3, 2)),
        uv_triangles=np.zeros_like(triangles),
        mirror=np.arange(count, dtype=np.int32),
        lighter=undecimated(triangles, count),
        canonical_pose=np.zeros((3, 3)),
        standing_pose=np.zeros((3, 3)),
    )
