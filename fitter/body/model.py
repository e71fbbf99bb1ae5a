"""The trained body model as plain arrays: d = U β + μ (section 3), with its articulation.

The training pipeline writes these fields, :mod:`fitter.body.storage` reads and checks them, and
:mod:`fitter.body.scape` evaluates them. Nothing here computes.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Pose, Triangles, Vertices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SparseRows:
    """Rows of a sparse matrix over the m vertices (CSR): row r is a weighted sum of vertices."""

    names: tuple[str, ...]
    pointers: Integer[np.ndarray, " r1"]
    indices: Integer[np.ndarray, " z"]
    weights: Float[np.ndarray, " z"]


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
        stands for half the turn of joint j (:mod:`fitter.body.pose_features`).
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
    canonical_pose: Pose
    standing_pose: Pose

    @property
    def checksum(self) -> str:
        """Of the file it was read from; empty for a model that never was one."""
        return str(self.header.get("checksum", ""))
