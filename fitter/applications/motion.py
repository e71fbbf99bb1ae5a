"""A person in motion: poses frame by frame, and the exact bodies they give."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Float32

from fitter.arrays import Pose, Shape
from fitter.body.scape import ScapeEvaluator
from fitter.numerics.rotations import rotation_matrices
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Motion:
    """Poses of one skeleton, frame by frame.

    Attributes
    ----------
    frame_time_s
        Seconds from frame to frame.
    poses
        (t, p, 3) as in :class:`~fitter.parameters.BodyParameters`.
    roots
        (t, 3) the root joint as far as the source knows it; body frame's axes, metres.
    lifts_m
        (t,) how far above the ground the lowest point of the body is: zero unless it jumps.
    """

    frame_time_s: float
    poses: Float[np.ndarray, "t p 3"]
    roots: Float[np.ndarray, "t 3"]
    lifts_m: Float[np.ndarray, " t"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MovingBody:
    """Exact SCAPE bodies of a motion.

    A vertex of frame t is at ``rotations[t] @ shapes[t] + roots[t]`` in the body frame's axes, with
    the ground at y = 0.

    Attributes
    ----------
    motion
        What it was made of.
    shapes
        (t, m, 3) with the root joint at the origin and the pelvis not turned, metres.
    rotations
        (t, 3, 3) of the pelvis.
    roots
        (t, 3) the root joint, metres.
    """

    motion: Motion
    shapes: Float32[np.ndarray, "t m 3"]
    rotations: Float[np.ndarray, "t 3 3"]
    roots: Float[np.ndarray, "t 3"]

    def vertices(self, frame: int) -> Float[np.ndarray, "m 3"]:
        """The body in a frame, body frame's axes, metres."""
        return self.shapes[frame] @ self.rotations[frame].T + self.roots[frame]


def unturned(pose: Pose) -> Pose:
    """The pose with the whole body upright and facing forward."""
    return np.concatenate([np.zeros((1, 3)), pose[1:]])


def moving_body(evaluator: ScapeEvaluator, shape: Shape, motion: Motion) -> MovingBody:
    """The bodies of a motion where its source puts them."""
    shapes = np.empty((len(motion.poses), len(evaluator.model.mean_vertices), 3), dtype=np.float32)
    for frame, pose in enumerate(motion.poses):
        shapes[frame] = evaluator.body_frame_vertices(
            BodyParameters(pose=unturned(pose), translation=np.zeros(3), shape=shape)
        )
    return MovingBody(
        motion=motion,
        shapes=shapes,
        rotations=rotation_matrices(motion.poses[:, 0]),
        roots=motion.roots,
    )
