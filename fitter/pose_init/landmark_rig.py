"""Linear blend skinning of the landmarks alone: as much of the body as the first pose needs.

A clicked point is compared with a landmark regressed from vertices, not with a joint centre. Each
landmark is a weighted sum of vertices and each vertex follows a few parts, so a landmark is a sum
of rigid terms over parts: linear blend skinning of some twenty points instead of the mesh.
All functions take a batch of poses in the leading axes, as pose hypotheses are refined together.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Shape
from fitter.body.model import BodyModel, SparseRows
from fitter.body.scape import CAMERA_AXES
from fitter.numerics.rotations import rotation_matrices


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
class PosedLandmarks:
    """Landmarks of a batch of poses.

    Attributes
    ----------
    points
        (..., k, 3) camera frame, metres.
    shares
        (..., k, p, 3) the terms whose sum over parts is a landmark, body frame axes, root joint
        at the origin; they include the rig's ``weights``.
    rotations, joints
        (..., p, 3, 3) and (..., p, 3), body frame axes, root joint at the origin.
    """

    points: Float[np.ndarray, "... k 3"]
    shares: Float[np.ndarray, "... k p 3"]
    rotations: Float[np.ndarray, "... p 3 3"]
    joints: Float[np.ndarray, "... p 3"]


def landmark_rig(model: BodyModel, shape: Shape) -> LandmarkRig:
    """The rig of a model's person with this shape."""
    rows = model.landmarks
    used = np.concatenate([model.joint_regressor.indices, rows.indices])
    places = model.mean_vertices[used] + np.tensordot(shape, model.shape_basis[:, used], axes=1)
    split = len(model.joint_regressor.indices)
    rest_joints = _weighted_sums(model.joint_regressor, places[:split])
    landmark = np.repeat(np.arange(len(rows.names)), np.diff(rows.pointers))
    parts = model.skinning_parts[rows.indices]
    shares = rows.weights[:, None] * model.skinning_weights[rows.indices]
    shares /= model.skinning_weights[rows.indices].sum(axis=1, keepdims=True)
    weights = np.zeros((len(rows.names), len(model.part_names)))
    arms = np.zeros((*weights.shape, 3))
    offsets = places[split:, None] - rest_joints[parts]
    np.add.at(weights, (landmark[:, None], parts), shares)
    np.add.at(arms, (landmark[:, None], parts), shares[..., None] * offsets)
    return LandmarkRig(
        part_names=model.part_names,
        part_parent=model.part_parent,
        rest_joints=rest_joints,
        landmark_names=rows.names,
        rest_landmarks=_weighted_sums(rows, places[split:]),
        weights=weights,
        arms=arms,
    )


def _weighted_sums(rows: SparseRows, places: Float[np.ndarray, "z 3"]) -> Float[np.ndarray, "r 3"]:
    """The rows' weighted sums, from the positions of the vertices the rows name."""
    return np.add.reduceat(rows.weights[:, None] * places, rows.pointers[:-1], axis=0)


def pose_landmarks(
    rig: LandmarkRig,
    pose: Float[np.ndarray, "... p 3"],
    translation: Float[np.ndarray, "... 3"],
) -> PosedLandmarks:
    """Landmarks in the camera frame for a batch of poses (radians) and root positions (metres)."""
    p = len(rig.part_names)
    local = rotation_matrices(pose.reshape(-1, 3)).reshape(*pose.shape, 3)
    rotations = np.empty_like(local)
    joints = np.zeros_like(pose)
    for part, parent in enumerate(rig.part_parent):
        if parent < 0:
            rotations[..., part, :, :] = local[..., part, :, :]
            continue
        bone = rig.rest_joints[part] - rig.rest_joints[parent]
        rotations[..., part, :, :] = rotations[..., parent, :, :] @ local[..., part, :, :]
        joints[..., part, :] = joints[..., parent, :] + rotations[..., parent, :, :] @ bone
    # (..., p, k, 3) = arms (p, k, 3) times transposed rotations (..., p, 3, 3).
    shares = np.matmul(rig.arms.transpose(1, 0, 2), np.swapaxes(rotations, -1, -2))
    shares = shares + rig.weights.T[:, :, None] * joints[..., :, None, :]
    points = shares.sum(axis=-3) * CAMERA_AXES + translation[..., None, :]
    return PosedLandmarks(
        points=points,
        shares=shares.reshape(*pose.shape[:-2], p, -1, 3).swapaxes(-3, -2),
        rotations=rotations,
        joints=joints,
    )
