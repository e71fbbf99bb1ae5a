"""A person in motion: poses frame by frame, and the exact bodies they give.

Another skeleton's root is right only about: proportions differ, and scaling by leg length leaves
centimetres. Two rules mend it. *Height*: the lowest vertex of every frame is at y = 0, or at the
lift of the source where that has left the ground. *Place*: between two frames the root moves so
that what touches the ground of the soles stands still, as in rolling without slip; only where
nothing touches it, it moves as the source's. Where that leads elsewhere than the source goes, but
slowly, the difference is spread over all frames, and feet slide by it.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Float32, Integer

from fitter.applications.poses import Angles, Rig, angled_pose
from fitter.arrays import Pose, Shape
from fitter.body.model import BodyModel
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


FRAMES_PER_SECOND = 30.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Cycle:
    """A motion that repeats itself.

    Attributes
    ----------
    duration_s
        Until it begins anew.
    times
        How often it is shown where nothing else is asked for.
    angles
        By part, at a phase that is 0 where it begins and 1 where it begins anew; parts that are not
        named are held as at rest.
    """

    duration_s: float
    times: int
    angles: Callable[[float], Mapping[str, Angles]]

    @property
    def frames(self) -> int:
        """In how many it is shown, at about 30 a second."""
        return max(2, round(self.duration_s * FRAMES_PER_SECOND))

    @property
    def frame_time_s(self) -> float:
        """Seconds from frame to frame."""
        return self.duration_s / self.frames


def motion_of_cycle(cycle: Cycle, rig: Rig, *, first: int = 0, frames: int | None = None) -> Motion:
    """Frames of a motion without end, from the ``first`` on, on one spot.

    Without a number, as often as is usual: the last frame is one before the first, so that they
    can be played in a loop.
    """
    count = cycle.times * cycle.frames if frames is None else frames
    numbers = np.arange(first, first + count) % cycle.frames
    phases = (float(number) / cycle.frames for number in numbers)
    poses = np.stack([angled_pose(rig, cycle.angles(phase)) for phase in phases])
    return Motion(
        frame_time_s=cycle.frame_time_s,
        poses=poses,
        roots=np.zeros((len(poses), 3)),
        lifts_m=np.zeros(len(poses)),
    )


CONTACT_HEIGHT_M = 0.004
"""Height above the ground at which a vertex of the sole counts 1/e of one that touches it: the
flesh that a foot presses flat, which the rigid sole of the model does not have."""

SOLE_HEIGHT_M = 0.03
"""Vertices of the feet this near to the lowest at rest are the soles."""

SOURCE_WEIGHT = 0.02
"""Weight of the source's own motion, beside vertices of weight up to one each."""

SLOWEST_M_PER_S = 0.05
"""At which feet may slide to keep the source's way: 1.7 mm a frame of 30 a second. A recorded walk
of 4.7 m, which ended 0.11 m away, needs 0.013."""


def grounded(body: MovingBody, model: BodyModel) -> MovingBody:
    """The same bodies with their roots moved."""
    lowest = [
        (shape @ turn[1]).min() for shape, turn in zip(body.shapes, body.rotations, strict=True)
    ]
    roots = body.roots.copy()
    roots[:, 1] = body.motion.lifts_m - lowest
    soles = _soles(body, model)
    weights = _touching(soles[:, :, 1] + roots[:, None, 1])
    back = -np.diff(soles[:, :, [0, 2]], axis=0)
    steps = np.einsum("tc,tci->ti", weights, back)
    steps += SOURCE_WEIGHT * np.diff(roots[:, [0, 2]], axis=0)
    steps /= (weights.sum(axis=1) + SOURCE_WEIGHT)[:, None]
    roots[1:, [0, 2]] = roots[0, [0, 2]] + np.cumsum(steps, axis=0)
    lost = (body.roots - roots)[-1] * [1.0, 0.0, 1.0]
    if np.linalg.norm(lost) <= SLOWEST_M_PER_S * len(roots) * body.motion.frame_time_s:
        roots += np.linspace(0.0, 1.0, len(roots))[:, None] * lost
    return replace(body, roots=roots)


SPOT_M = 0.5
"""How far from its straight way a body still counts as on the spot: people sway, squat and step."""

_EVEN_S = 1.0


def in_place(body: MovingBody) -> MovingBody:
    """The same bodies without their way along the ground, heights kept.

    The straight way from the first frame to the last is taken out, so that a walk can be repeated;
    of a body that goes elsewhere, the way of each second around.
    """
    ground = body.roots[:, [0, 2]]
    way = np.linspace(ground[0], ground[-1], len(ground))
    if np.linalg.norm(ground - way, axis=1).max() > SPOT_M:
        half = min(round(0.5 * _EVEN_S / body.motion.frame_time_s), len(ground) - 1)
        # Continued beyond its ends as a half turn about them shows it, so that it begins and ends
        # where the body does.
        before = 2.0 * ground[0] - ground[half:0:-1]
        after = 2.0 * ground[-1] - ground[-2 : -half - 2 : -1]
        sums = np.cumsum(np.concatenate([np.zeros((1, 2)), before, ground, after]), axis=0)
        way = (sums[2 * half + 1 :] - sums[: -2 * half - 1]) / (2 * half + 1)
    roots = body.roots.copy()
    roots[:, [0, 2]] -= way
    return replace(body, roots=roots)


def sliding_m(body: MovingBody, model: BodyModel) -> float:
    """Mean slide, from frame to frame, of what touches the ground of the soles, metres."""
    soles = _soles(body, model) + body.roots[:, None]
    weights = _touching(soles[:, :, 1])
    moved = np.linalg.norm(np.diff(soles[:, :, [0, 2]], axis=0), axis=2)
    return float((weights * moved).sum() / max(weights.sum(), 1e-12))


def _soles(body: MovingBody, model: BodyModel) -> Float[np.ndarray, "t c 3"]:
    """Vertices of the soles with the root at the origin, body frame's axes."""
    shapes = body.shapes[:, sole_vertices(model)].astype(np.float64)
    return np.einsum("tij,tcj->tci", body.rotations, shapes)


def sole_vertices(model: BodyModel) -> Integer[np.ndarray, " c"]:
    """The lowest vertices of both feet at rest."""
    feet = [model.part_names.index(f"{side}_foot") for side in ("left", "right")]
    vertices = np.unique(model.triangles[np.isin(model.part_of_triangle, feet)])
    heights = model.mean_vertices[vertices, 1]
    return vertices[heights < heights.min() + SOLE_HEIGHT_M]


def _touching(heights: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t1 c"]:
    """Contact of each vertex with the ground from a frame to the next, in [0, 1]."""
    weights = np.exp(-np.maximum(heights, 0.0) / CONTACT_HEIGHT_M)
    return np.minimum(weights[1:], weights[:-1])
