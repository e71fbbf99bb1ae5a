"""Linear blend skinning of the landmarks alone: as much of the body as the first pose needs.

A clicked point is compared with a landmark regressed from vertices, not with a joint centre. Each
landmark is a weighted sum of vertices and each vertex follows a few parts, so a landmark is a sum
of rigid terms over parts: linear blend skinning of some twenty points instead of the mesh.
"""

from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from jaxtyping import Float, Integer
from scipy import sparse

from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel, SparseRows
from fitter.numerics.rotations import rotation_matrices
from fitter.pose_init._landmark_kernels import Rig, pose_rig

_MODELS = 4
"""Number of models whose rigs are kept."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LandmarkRig:
    """A person's skeleton and landmarks at rest, body frame, metres.

    Attributes
    ----------
    part_names, part_parent
        The kinematic chain, p parts.
    rest_joints
        (p, 3) joint centres.
    landmark_names
        k names.
    rest_landmarks
        (k, 3) landmarks at rest.
    weights
        (k, p) share of each landmark that follows each part; rows sum to 1.
    arms
        (k, p, 3) weight times the offset of the landmark's share from the part's joint.
    """

    part_names: tuple[str, ...]
    part_parent: Integer[np.ndarray, " p"]
    rest_joints: Float[np.ndarray, "p 3"]
    landmark_names: tuple[str, ...]
    rest_landmarks: Float[np.ndarray, "k 3"]
    weights: Float[np.ndarray, "k p"]
    arms: Float[np.ndarray, "k p 3"]

    def landmark(self, name: str) -> Float[np.ndarray, "3"]:
        """Rest position of a landmark."""
        return self.rest_landmarks[self.landmark_names.index(name)]

    def part(self, name: str) -> int:
        """Index of a part."""
        return self.part_names.index(name)

    def only(self, names: tuple[str, ...]) -> "LandmarkRig":
        """The same skeleton with these landmarks, in this order."""
        rows = [self.landmark_names.index(name) for name in names]
        return LandmarkRig(
            part_names=self.part_names,
            part_parent=self.part_parent,
            rest_joints=self.rest_joints,
            landmark_names=names,
            rest_landmarks=self.rest_landmarks[rows],
            weights=self.weights[rows],
            arms=self.arms[rows],
        )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RigSpace:
    """The rig of every shape: the mean's, and the change of what depends on the shape.

    Joints, landmarks and arms are linear in vertices, and these in the shape. ``changes`` (n, r) by
    coefficient are those of a :class:`LandmarkRig`'s ``rest_joints``, ``rest_landmarks`` and
    ``arms`` as one row.
    """

    mean: LandmarkRig
    changes: Float[np.ndarray, "n r"]


def landmark_rig(model: BodyModel, shape: Shape) -> LandmarkRig:
    """The rig of a model's person with this shape."""
    space = rig_space(model)
    mean = space.mean
    whole = [mean.rest_joints, mean.rest_landmarks, mean.arms]
    row = np.concatenate([each.reshape(-1) for each in whole]) + shape @ space.changes
    ends = np.cumsum([each.size for each in whole])
    joints, landmarks, arms = (
        part.reshape(each.shape) for part, each in zip(np.split(row, ends[:-1]), whole, strict=True)
    )
    return replace(mean, rest_joints=joints, rest_landmarks=landmarks, arms=arms)


@lru_cache(maxsize=_MODELS)
def rig_space(model: BodyModel) -> RigSpace:
    """A model's rigs: some twenty of them, once a process."""
    shares = _vertex_shares(model)
    mean = _rig(model, shares, model.mean_vertices)
    changes = [_rig(model, shares, change) for change in model.shape_basis]
    return RigSpace(
        mean=mean,
        changes=np.stack(
            [
                np.concatenate(
                    [each.rest_joints.ravel(), each.rest_landmarks.ravel(), each.arms.ravel()]
                )
                for each in changes
            ]
        ),
    )


def _rig(model: BodyModel, shares: sparse.csr_array, vertices: Vertices) -> LandmarkRig:
    rest_joints = _weighted_sums(model.joint_regressor, vertices)
    shape = (len(model.landmarks.names), len(model.part_names))
    weights = shares.sum(axis=1).reshape(shape)
    return LandmarkRig(
        part_names=model.part_names,
        part_parent=model.part_parent,
        rest_joints=rest_joints,
        landmark_names=model.landmarks.names,
        rest_landmarks=_weighted_sums(model.landmarks, vertices),
        weights=weights,
        arms=(shares @ vertices).reshape(*shape, 3) - weights[:, :, None] * rest_joints,
    )


def _vertex_shares(model: BodyModel) -> sparse.csr_array:
    """(k p, m) how much of a landmark is each vertex by each part that moves the vertex."""
    rows = model.landmarks
    landmark = np.repeat(np.arange(len(rows.names)), np.diff(rows.pointers))
    parts = model.skinning_parts[rows.indices]
    shares = rows.weights[:, None] * model.skinning_weights[rows.indices]
    shares /= model.skinning_weights[rows.indices].sum(axis=1, keepdims=True)
    row = landmark[:, None] * len(model.part_names) + parts
    column = np.broadcast_to(rows.indices[:, None], row.shape)
    size = (len(rows.names) * len(model.part_names), len(model.skinning_parts))
    return sparse.csr_array((shares.ravel(), (row.ravel(), column.ravel())), shape=size)


def _weighted_sums(rows: SparseRows, vertices: Vertices) -> Float[np.ndarray, "r 3"]:
    """The rows' weighted sums of vertices."""
    terms = rows.weights[:, None] * vertices[rows.indices]
    return np.add.reduceat(terms, rows.pointers[:-1], axis=0)


def landmark_points(
    rig: LandmarkRig,
    pose: Float[np.ndarray, "... p 3"],
    translation: Float[np.ndarray, "... 3"],
) -> Float[np.ndarray, "... k 3"]:
    """Landmarks in the camera frame for a batch of poses (radians) and root positions (metres)."""
    arrays = rig_arrays(rig)
    local = rotation_matrices(pose.reshape(-1, 3)).reshape(-1, *pose.shape[-2:], 3)
    points = [
        pose_rig(arrays, each, place).points
        for each, place in zip(local, translation.reshape(-1, 3), strict=True)
    ]
    return np.stack(points).reshape(*pose.shape[:-2], -1, 3)


def rig_arrays(rig: LandmarkRig) -> Rig:
    """A rig as its kernels take it."""
    return Rig(
        parents=np.ascontiguousarray(rig.part_parent, dtype=np.int64),
        rest_joints=np.ascontiguousarray(rig.rest_joints),
        weights=np.ascontiguousarray(rig.weights),
        arms=np.ascontiguousarray(rig.arms),
    )
