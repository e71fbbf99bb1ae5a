"""The trained body model as plain arrays: d = U β + μ (section 3), with its articulation.

The training pipeline writes these fields, :mod:`fitter.body.storage` reads and checks them, and
:mod:`fitter.body.scape` evaluates them. Nothing here computes.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose, Rotations, Triangles, Vertices
from fitter.body._scape_kernels import chain_joints, chain_rotations, weighted_sums
from fitter.numerics.rotations import rotation_matrices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SparseRows:
    """Rows of a sparse matrix over the m vertices (CSR): row r is a weighted sum of vertices."""

    names: tuple[str, ...]
    pointers: Integer[np.ndarray, " r1"]
    indices: Integer[np.ndarray, " z"]
    weights: Float[np.ndarray, " z"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LighterMesh:
    """A mesh of k of the m vertices, on which bodies are searched for.

    Attributes
    ----------
    kept
        (k,) the vertices that remain, ascending.
    triangles
        (g, 3) into ``kept``, closed and manifold.
    origin
        (g,) the triangle of the whole surface that each was.
    corners, shares
        (m, 3) the triangle, into ``kept``, that stands for each vertex, and where in it: its own
        corner for one that remains, else the nearest of those around the vertex it moved onto.
    """

    kept: Integer[np.ndarray, " k"]
    triangles: Triangles
    origin: Integer[np.ndarray, " g"]
    corners: Integer[np.ndarray, "m 3"]
    shares: Float[np.ndarray, "m 3"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyModel:
    """A SCAPE model of one gender, in the body frame (metres, y up, z forward), rest pose.

    Attributes
    ----------
    gender
        ``female`` or ``male``.
    header
        Provenance: sources, licences, seeds, number of subjects, held-out errors.
    triangles
        (f, 3) closed, manifold, genus 0, counter-clockwise seen from outside.
    mean_vertices
        (m, 3) μ: the mean body at rest.
    shape_basis
        (n, m, 3) U: vertex displacement for one standard deviation of each coefficient of the
        height-preserving basis. Axis 0 is the height axis. Linear combinations of the
        deformation gradients of meshes in one pose are linear combinations of the meshes, so
        vertices store U without loss.
    part_names, part_parent
        p parts; parent index, -1 for the root (pelvis). Parents precede children.
    part_of_triangle
        (f,) the rigid part of each triangle.
    triangle_weights
        (f,) weight of each triangle in the SCAPE least squares.
    joint_regressor
        p rows: the centre about which each part turns relative to its parent (root: pelvis).
    skinning_parts, skinning_weights
        (m, 4) the parts whose motion a vertex follows: the linear-blend tangent.
    pose_feature_joints
        (p, q) joints whose (R - I) drives the part's pose-dependent term, -1 where unused; p + j
        stands for half the turn of joint j (:mod:`fitter.body.scape`).
    pose_feature_strengths
        (p, 9 q, n) how strongly each feature acts on bodies of other shapes: times 1 + s . β.
    incidence_pointers, incidence_vertices
        Part by part, the vertices its triangles touch (CSR-like).
    pose_right_hand_sides
        (incidences, 3, 9 q) the pose-dependent term as right-hand sides of the least squares in
        the part's frame: multiply by the flattened features (1 + s . β) (R - I),
        joint-major.
    landmarks
        Rows by name: the 17 COCO points, ``neck``, ``head_top``, ``chin``, toes, heels, and the
        anatomical landmarks measurements are defined by.
    uv, uv_triangles
        Texture layout of the mesh.
    mirror
        (m,) the vertex on the other side of the body.
    lighter
        The mesh of the searches (:mod:`fitter.body.lighter_model`).
    canonical_pose
        (p, 3) arms away from the trunk, for measuring; ``standing_pose`` upright with legs
        straight, for stature.
    """

    gender: str
    header: Mapping[str, object]
    triangles: Triangles
    mean_vertices: Vertices
    shape_basis: Float[np.ndarray, "n m 3"]
    part_names: tuple[str, ...]
    part_parent: Integer[np.ndarray, " p"]
    part_of_triangle: Integer[np.ndarray, " f"]
    triangle_weights: Float[np.ndarray, " f"]
    joint_regressor: SparseRows
    skinning_parts: Integer[np.ndarray, "m 4"]
    skinning_weights: Float[np.ndarray, "m 4"]
    pose_feature_joints: Integer[np.ndarray, "p q"]
    pose_feature_strengths: Float[np.ndarray, "p nine_q n"]
    incidence_pointers: Integer[np.ndarray, " p1"]
    incidence_vertices: Integer[np.ndarray, " i"]
    pose_right_hand_sides: Float[np.ndarray, "i 3 nine_q"]
    landmarks: SparseRows
    uv: Float[np.ndarray, "u 2"]
    uv_triangles: Triangles
    mirror: Integer[np.ndarray, " m"]
    lighter: LighterMesh
    canonical_pose: Pose
    standing_pose: Pose

    @property
    def checksum(self) -> str:
        """Checksum of the file it was read from; empty for a model that never was one."""
        return str(self.header.get("checksum", ""))


def regress(rows: SparseRows, vertices: Vertices) -> Float[np.ndarray, "r 3"]:
    """Weighted sums of vertices, one point per row, in the frame of the vertices."""
    result = np.empty((len(rows.pointers) - 1, 3))
    weighted_sums(rows.pointers, rows.indices, rows.weights, np.ascontiguousarray(vertices), result)
    return result


def dense_rows(rows: SparseRows, vertex_count: int) -> Float[np.ndarray, "r m"]:
    """The rows as a dense matrix, for precomputing products with bases."""
    dense = np.zeros((len(rows.pointers) - 1, vertex_count))
    row = np.repeat(np.arange(len(dense)), np.diff(rows.pointers))
    np.add.at(dense, (row, rows.indices), rows.weights)
    return dense


def global_rotations(pose: Pose, part_parent: Integer[np.ndarray, " p"]) -> Rotations:
    """Rotation of every part from rest to pose, in the body frame: R_parent exp(pose)."""
    local = rotation_matrices(pose)
    result = np.empty_like(local)
    chain_rotations(local, part_parent, result)
    return result


def posed_joints(
    rest_joints: Float[np.ndarray, "... p 3"],
    rotations: Rotations,
    part_parent: Integer[np.ndarray, " p"],
) -> Float[np.ndarray, "... p 3"]:
    """Joint positions of the rigid chain, body frame, metres, root joint at the origin."""
    chains = np.ascontiguousarray(rest_joints).reshape(-1, len(part_parent), 3)
    result = np.empty_like(chains)
    chain_joints(chains, rotations, part_parent, result)
    return result.reshape(rest_joints.shape)


def descendants(part_parent: Integer[np.ndarray, " p"]) -> np.ndarray:
    """(p, p) bool: entry [j, q] says that part q moves when joint j turns (q = j included)."""
    count = len(part_parent)
    result = np.eye(count, dtype=bool)
    for part in range(count):
        if part_parent[part] >= 0:
            result[:, part] |= result[:, part_parent[part]]
    return result
