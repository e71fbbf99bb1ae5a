"""A fitted person set in motion: by a BVH file, or by a motion that ships with the package."""

import io
import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from PIL import Image as PillowImage

from fitter.applications.animated_glb import morphed_glb, skin_of, skinned_glb, still_skin_of
from fitter.applications.bvh_export import bvh_of_motion
from fitter.applications.motion import (
    Motion,
    MovingBody,
    grounded,
    in_place,
    motion_of_cycle,
    moving_body,
    sliding_m,
)
from fitter.applications.motion_file import MotionFile
from fitter.applications.poses import NAMED_POSES, Rig, named_pose, rig_of
from fitter.applications.principal_frames import principal_frames
from fitter.applications.retarget import Axis, retarget
from fitter.applications.skeleton import skeleton_of
from fitter.applications.walk import stride_of
from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.export.gltf_mesh import BodyTexture
from fitter.export.views import EYE_LEVEL_M, before_onlooker, framing_camera, shown_body
from fitter.person.fitted_person import FittedPerson
from fitter.vocabulary.choices import BoneNames
from fitter.vocabulary.remarks import Note, Remark, remark

MOST_FRAMES = 360
"""Most frames: 12 s of animation at 30 a second, each an exact body of 149 kB while it is made."""

MOST_FRAMES_PER_SECOND = 30.0

FILM_PX = (300, 400)
"""Width and height."""

FILM_FRAMES_PER_SECOND = 15.0
MOST_FILM_FRAMES = 120

FILM_DEGREES = 40.0
"""From where the film is seen: between the front and the person's left."""

_QUALITY = 70

LOST_WAY_M = 0.1
"""Ends of a file's way and of the body's that are so far apart are told."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ChosenMotion:
    """A motion to animate a person with.

    ``source`` says where it comes from, ``up`` which axis of its file points up, and ``warnings``
    what was left out of it or is in doubt.
    """

    motion: Motion
    source: str
    up: Axis | None
    warnings: tuple[Remark, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Animation:
    """A person in motion.

    Attributes
    ----------
    files
        ``body_animated.glb`` (exact bodies by morph targets), ``body_skinned.glb`` (linear
        blending), ``motion.bvh`` (its bones) and ``animation.webp`` (a film that follows the
        person, again and again); of a rig ``body_skinned.glb`` alone.
    frames, frame_time_s
        How many, and seconds from one to the next.
    morph_targets
        Of ``body_animated.glb``.
    morph_largest_error_mm, morph_mean_error_mm
        Distance of its vertices from exact SCAPE, over all frames.
    skin_largest_error_mm, skin_mean_error_mm
        The same of ``body_skinned.glb``; of a rig, over the poses that have names.
    sliding_mm
        How far soles slide on the ground from frame to frame, mean.
    travelled_m
        From the first place to the last, along the ground, though the files may be in place.
    warnings
        What was left out of the motion or is in doubt.
    """

    files: Mapping[str, bytes]
    frames: int
    frame_time_s: float
    morph_targets: int
    morph_largest_error_mm: float
    morph_mean_error_mm: float
    skin_largest_error_mm: float
    skin_mean_error_mm: float
    sliding_mm: float
    travelled_m: float
    warnings: tuple[Remark, ...]


def motion_of_clip(
    source: MotionFile, rig: Rig, *, duration_s: float | None = None, up: Axis | None = None
) -> ChosenMotion:
    """A stretch of a BVH file on a person's skeleton, thinned out to 30 frames a second at most.

    Parameters
    ----------
    source
        The file, and where the stretch begins.
    rig
        The person's skeleton.
    duration_s
        How long it is; None goes on to the clip's end. What is longer than there may be frames is
        cut, with a warning.
    up
        The file's axis that points up; found from the motion if None.
    """
    clip = source.clip
    # Whole steps only: every frame that is shown is one that was recorded.
    # Files round their frame times: 0.0083333 s is meant for 120 Hz.
    step = max(1, math.ceil(1.0 / (clip.frame_time_s * MOST_FRAMES_PER_SECOND) - 0.01))
    wanted = clip.frames - source.first
    if duration_s is not None:
        wanted = min(wanted, max(1, round(duration_s / clip.frame_time_s)))
    frames = min((wanted + step - 1) // step, MOST_FRAMES)
    retargeted = retarget(source, rig, source.first + step * np.arange(frames), up=up)
    return ChosenMotion(
        motion=retargeted.motion,
        source=f"BVH with the names of {source.naming}",
        up=retargeted.up.axis,
        warnings=(
            *clip.warnings,
            *retargeted.up.warnings,
            *_cut_warnings(frames * step, wanted, clip.frame_time_s),
        ),
    )


def motion_of_walk(
    rig: Rig, *, start_s: float = 0.0, duration_s: float | None = None
) -> ChosenMotion:
    """A stretch of the walk that ships with the package, which has no end.

    Parameters
    ----------
    rig
        The person's skeleton.
    start_s, duration_s
        Which stretch; None is as often as is usual. What is longer than there may be frames is
        cut, with a warning.
    """
    cycle = stride_of(rig)
    first = round(start_s / cycle.frame_time_s)
    wanted = cycle.times * cycle.frames
    if duration_s is not None:
        wanted = max(1, round(duration_s / cycle.frame_time_s))
    frames = min(wanted, MOST_FRAMES)
    return ChosenMotion(
        motion=motion_of_cycle(cycle, rig, first=first, frames=frames),
        source="the walk that ships with the package",
        up=None,
        warnings=_cut_warnings(frames, wanted, cycle.frame_time_s),
    )


def _cut_warnings(shown: int, wanted: int, frame_time_s: float) -> tuple[Remark, ...]:
    if shown >= wanted:
        return ()
    message = (
        f"{shown * frame_time_s:.2f} of {wanted * frame_time_s:.2f} s are shown: an animation "
        f"has {MOST_FRAMES} frames at most."
    )
    return (remark(Note.CLIP_CUT, message),)


def animate(
    person: FittedPerson,
    evaluator: ScapeEvaluator,
    chosen: ChosenMotion,
    *,
    texture: BodyTexture | None = None,
    bones: BoneNames = BoneNames.MAQUETTE,
    travels: bool = True,
) -> Animation:
    """Set a fitted person in motion, feet on the ground; a texture is in both GLB files.

    The files show the body's way along the ground where it ``travels``, else the body in place.
    """
    model, shape, motion = evaluator.model, person.body.shape, chosen.motion
    body = grounded(moving_body(evaluator, shape, motion), model)
    shown = body if travels else in_place(body)
    # The film before the large files: while it is made all its pictures are in memory.
    files = {"animation.webp": _film(shown, model, texture)}
    exact = principal_frames(body.shapes)
    skeleton = skeleton_of(evaluator, shape, rig_of(model, shape), bones)
    skin = skin_of(body, model, skeleton)
    files |= {
        "body_animated.glb": morphed_glb(
            shown,
            exact,
            model,
            reflectance=person.reflectance,
            albedo_rgb=person.albedo_rgb,
            texture=texture,
        ),
        "body_skinned.glb": skinned_glb(
            shown,
            skin,
            model,
            reflectance=person.reflectance,
            albedo_rgb=person.albedo_rgb,
            texture=texture,
        ),
        "motion.bvh": bvh_of_motion(shown, skeleton, model),
    }
    way = body.roots[-1] - body.roots[0]
    return Animation(
        files=files,
        frames=len(body.shapes),
        frame_time_s=motion.frame_time_s,
        morph_targets=len(exact.targets),
        morph_largest_error_mm=1e3 * exact.largest_error_m,
        morph_mean_error_mm=1e3 * exact.mean_error_m,
        skin_largest_error_mm=1e3 * skin.largest_error_m,
        skin_mean_error_mm=1e3 * skin.mean_error_m,
        sliding_mm=1e3 * sliding_m(body, model),
        travelled_m=float((way[0] ** 2 + way[2] ** 2) ** 0.5),
        warnings=(*chosen.warnings, *way_warnings(chosen, body)),
    )


def rigged(
    person: FittedPerson,
    evaluator: ScapeEvaluator,
    pose: str,
    *,
    texture: BodyTexture | None = None,
    bones: BoneNames = BoneNames.MAQUETTE,
) -> Animation:
    """A fitted person bound to bones in a pose by name, for programs that move it themselves."""
    model, shape = evaluator.model, person.body.shape
    rig = rig_of(model, shape)
    names = (pose, *(name for name in NAMED_POSES if name != pose))
    poses = [named_pose(rig, name) for name in names]
    motion = Motion(
        frame_time_s=1.0 / MOST_FRAMES_PER_SECOND,
        poses=np.stack(poses),
        roots=np.zeros((len(poses), 3)),
        lifts_m=np.zeros(len(poses)),
    )
    body = grounded(moving_body(evaluator, shape, motion), model)
    skin = still_skin_of(body, model, skeleton_of(evaluator, shape, rig, bones))
    content = skinned_glb(
        body,
        skin,
        model,
        reflectance=person.reflectance,
        albedo_rgb=person.albedo_rgb,
        texture=texture,
    )
    return Animation(
        files={"body_skinned.glb": content},
        frames=1,
        frame_time_s=motion.frame_time_s,
        morph_targets=0,
        morph_largest_error_mm=0.0,
        morph_mean_error_mm=0.0,
        skin_largest_error_mm=1e3 * skin.largest_error_m,
        skin_mean_error_mm=1e3 * skin.mean_error_m,
        sliding_mm=0.0,
        travelled_m=0.0,
        warnings=(),
    )


def way_warnings(chosen: ChosenMotion, body: MovingBody) -> tuple[Remark, ...]:
    """A warning where feet that stay on the ground lead elsewhere than the file goes."""
    if chosen.up is None:
        return ()
    ways = [roots[:, [0, 2]] for roots in (chosen.motion.roots, body.roots)]
    planned, made = (np.linalg.norm(np.diff(way, axis=0), axis=1).sum() for way in ways)
    ends = [way[-1] - way[0] for way in ways]
    apart = float(np.linalg.norm(ends[1] - ends[0]))
    if apart < LOST_WAY_M:
        return ()
    message = (
        "Feet that touch the ground stay where they are, which leads elsewhere than the file: its "
        f"way is {planned:.2f} m long and the body's {made:.2f} m, and they end {apart:.2f} m "
        "apart."
    )
    return (remark(Note.WAY_DIFFERS, message),)


def _film(body: MovingBody, model: BodyModel, texture: BodyTexture | None) -> bytes:
    """An animated WebP of at most 15 frames a second; the camera goes along with the person."""
    frame_time_s = body.motion.frame_time_s
    step = max(
        1,
        round(1.0 / (FILM_FRAMES_PER_SECOND * frame_time_s)),
        -(-len(body.shapes) // MOST_FILM_FRAMES),
    )
    chosen = range(0, len(body.shapes), step)
    width, height = FILM_PX
    some = np.concatenate([_before_film(body, frame) for frame in chosen[::4]])
    camera = framing_camera(some, width=width, height=height)
    shown = (_before_film(body, frame) for frame in chosen)
    levels = (shown_body(each, model.triangles, camera, texture) for each in shown)
    pictures = [PillowImage.fromarray(each) for each in levels]
    stream = io.BytesIO()
    pictures[0].save(
        stream,
        format="WEBP",
        save_all=True,
        append_images=pictures[1:],
        duration=round(1000.0 * step * frame_time_s),
        loop=0,
        quality=_QUALITY,
    )
    return stream.getvalue()


def _before_film(body: MovingBody, frame: int) -> Vertices:
    along = np.array([body.roots[frame, 0], EYE_LEVEL_M, body.roots[frame, 2]])
    return before_onlooker(body.vertices(frame), along, FILM_DEGREES)
