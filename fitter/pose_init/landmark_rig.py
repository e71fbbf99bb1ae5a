"""Landmarks carried by a skeleton: the body at the level the first pose needs.

A clicked point is compared with a landmark regressed from vertices, not with a joint centre. Each
landmark is a weighted sum of vertices and each vertex follows a few parts, so a landmark is a sum
over parts of something rigid: linear blend skinning of some twenty points instead of the mesh.
All functions take a batch of poses in leading axes, because pose hypotheses are refined together.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import Shape
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES
from fitter.body.shape_space import rest_vertices
from fitter.body.skeleton import descendants, regress
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
        at the origin; weighted like the rig's ``weights``.
    rotations, joints
        (..., p, 3, 3) and (..., p, 3), body frame axes, root joint at the origin.
    """

    points: Float[np.ndarray, "... k 3"]
    shares: Float[np.ndarray, "... k p 3"]
    rotations: Float[np.ndarray, "... p 3 3"]
    joints: Float[np.ndarray, "... p 3"]


def landmark_rig(model: BodyModel, shape: Shape) -> LandmarkRig:
    """The rig of a model's person with this shape."""
    vertices = rest_vertices(model, shape)
    rest_joints = regress(model.joint_regressor, vertices)
    rows = model.landmarks
    landmark = np.repeat(np.arange(len(rows.names)), np.diff(rows.pointers))
    parts = model.skinning_parts[rows.indices]
    shares = rows.weights[:, None] * model.skinning_weights[rows.indices]
    shares /= model.skinning_weights[rows.indices].sum(axis=1, keepdims=True)
    weights = np.zeros((len(rows.names), len(model.part_names)))
    arms = np.zeros((*weights.shape, 3))
    offsets = vertices[rows.indices][:, None] - rest_joints[parts]
    np.add.at(weights, (landmark[:, None], parts), shares)
    np.add.at(arms, (landmark[:, None], parts), shares[..., None] * offsets)
    return LandmarkRig(
        part_names=model.part_names,
        part_parent=model.part_parent,
        rest_joints=rest_joints,
        landmark_names=rows.names,
        rest_landmarks=regress(rows, vertices),
        weights=weights,
        arms=arms,
    )


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


def landmark_jacobian(
    rig: LandmarkRig, posed: PosedLandmarks, turning: Bool[np.ndarray, " p"]
) -> Float[np.ndarray, "... k 3 columns"]:
    """Derivative of camera-frame landmarks by increments of the turning joints.

    Three columns a turning joint, for increments δ applied as exp(δ) exp(pose): the axes are those
    of the parent part, and a turn moves a landmark by axis × (its share beyond the joint).
    """
    joints = np.flatnonzero(turning)
    follows = descendants(rig.part_parent)[joints].astype(np.float64)
    beyond = np.matmul(follows, posed.shares)
    share = rig.weights @ follows.T
    beyond -= share[:, :, None] * posed.joints[..., None, joints, :]
    parents = rig.part_parent[joints]
    axes = posed.rotations[..., np.maximum(parents, 0), :, :].copy()
    axes[..., parents < 0, :, :] = np.eye(3)
    # d = axis × beyond = -[beyond]× axis, all three axes of a joint at once.
    moved = np.matmul(_minus_cross_matrices(beyond), axes[..., None, :, :, :])
    moved *= CAMERA_AXES[:, None]
    ordered = np.swapaxes(moved, -3, -2)
    return ordered.reshape(*ordered.shape[:-2], 3 * len(joints))


def _minus_cross_matrices(vectors: Float[np.ndarray, "... 3"]) -> Float[np.ndarray, "... 3 3"]:
    """Matrices M with M a = a × v."""
    matrices = np.zeros((*vectors.shape, 3))
    x, y, z = vectors[..., 0], vectors[..., 1], vectors[..., 2]
    matrices[..., 0, 1], matrices[..., 0, 2] = z, -y
    matrices[..., 1, 0], matrices[..., 1, 2] = -z, x
    matrices[..., 2, 0], matrices[..., 2, 1] = y, -x
    return matrices
