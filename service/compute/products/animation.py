"""The fitted body as a rig, walking, or moved by a BVH file sent with the request."""

from api_schemas.products.base import BodyColours
from api_schemas.products.bodies import AnimationOptions, AnimationResult, NamedMotion
from fitter.applications.animation import (
    ChosenMotion,
    animate,
    motion_of_clip,
    motion_of_walk,
    rigged,
)
from fitter.applications.motion_file import read_motion
from fitter.applications.poses import Rig, rig_of
from service.compute.products.finished_fit import FinishedFit, Made, Report
from service.compute.products.pictured_body import texture_files, texture_for
from service.jobs.inputs import CLIP


def make(fit: FinishedFit, options: AnimationOptions, report: Report) -> Made[AnimationResult]:
    """Set the body in motion."""
    person, evaluator = fit.person, fit.operators.evaluator
    is_rig = CLIP not in fit.files and options.motion in (NamedMotion.A_POSE, NamedMotion.T_POSE)
    rig = rig_of(evaluator.model, person.body.shape)
    chosen = None if is_rig else _chosen(fit.files.get(CLIP), options, rig)
    report(0.1)
    texture = texture_for(options.colours, fit)
    report(0.2)
    if chosen is None:
        made = rigged(person, evaluator, options.motion, texture=texture, bones=options.bones)
    else:
        made = animate(
            person,
            evaluator,
            chosen,
            texture=texture,
            bones=options.bones,
            travels=not options.in_place,
        )
    return Made(
        result=AnimationResult(
            colours=BodyColours.PLAIN if texture is None else options.colours,
            motion=None if CLIP in fit.files else options.motion,
            source="a pose that ships with the package" if chosen is None else chosen.source,
            up=None if chosen is None else chosen.up,
            frames=made.frames,
            frame_time_s=made.frame_time_s,
            morph_targets=made.morph_targets,
            morph_mean_error_mm=made.morph_mean_error_mm,
            morph_largest_error_mm=made.morph_largest_error_mm,
            skin_mean_error_mm=made.skin_mean_error_mm,
            skin_largest_error_mm=made.skin_largest_error_mm,
            sliding_mm=made.sliding_mm,
            travelled_m=made.travelled_m,
            warnings=made.warnings,
        ),
        files=dict(made.files) | texture_files(texture),
    )


def _chosen(clip: bytes | None, options: AnimationOptions, rig: Rig) -> ChosenMotion:
    if clip is None:
        return motion_of_walk(rig, start_s=options.start_s, duration_s=options.duration_s)
    source = read_motion(clip, named=options.joints, start_s=options.start_s)
    return motion_of_clip(source, rig, duration_s=options.duration_s, up=options.up)
