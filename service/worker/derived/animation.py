"""The fitted body in motion: from a BVH file sent with the request, or by name."""

from collections.abc import Callable

from api_schemas.derivation_kinds.animation import AnimationOptions, AnimationResult
from api_schemas.derivation_kinds.base import BodyColours
from api_schemas.results import FitWarning
from fitter.applications.animation import (
    ChosenMotion,
    animate,
    motion_of_clip,
    motion_of_name,
)
from fitter.applications.motion_file import read_motion
from fitter.applications.rig import Rig, rig_of
from service.jobs.inputs import CLIP, PERSON
from service.worker.derived.person import person_and_operators
from service.worker.derived.pictured_body import texture_files, texture_for
from service.worker.pipeline_port import DerivationInput, DerivationOutput


def derive(
    job: DerivationInput[AnimationOptions], observe: Callable[[float], None]
) -> DerivationOutput[AnimationResult]:
    """Set the body in motion; see :class:`service.worker.derivers.Deriver`."""
    options = job.options
    person, operators = person_and_operators(job.inputs[PERSON], job.models)
    rig = rig_of(operators.model, person.body.shape)
    chosen = _chosen(job.inputs.get(CLIP), options, rig)
    observe(0.1)
    texture = texture_for(
        options.colours, person, operators.evaluator, job.inputs, max_pixels=job.max_pixels
    )
    observe(0.2)
    made = animate(person, operators.evaluator, chosen.motion, texture=texture)
    return DerivationOutput(
        result=AnimationResult(
            colours=BodyColours.PLAIN if texture is None else options.colours,
            motion=None if CLIP in job.inputs else options.motion,
            source=chosen.source,
            up=chosen.up,
            frames=made.frames,
            frame_time_s=made.frame_time_s,
            morph_targets=made.morph_targets,
            morph_mean_error_mm=made.morph_mean_error_mm,
            morph_largest_error_mm=made.morph_largest_error_mm,
            skin_mean_error_mm=made.skin_mean_error_mm,
            skin_largest_error_mm=made.skin_largest_error_mm,
            sliding_mm=made.sliding_mm,
            travelled_m=made.travelled_m,
            warnings=tuple(
                FitWarning(code=each.code, message=each.message) for each in chosen.warnings
            ),
            files=(),
        ),
        files=dict(made.files) | texture_files(texture),
    )


def _chosen(clip: bytes | None, options: AnimationOptions, rig: Rig) -> ChosenMotion:
    if clip is None:
        return motion_of_name(
            rig, options.motion, start_s=options.start_s, duration_s=options.duration_s
        )
    source = read_motion(clip, named=options.joints, start_s=options.start_s)
    return motion_of_clip(source, rig, duration_s=options.duration_s, up=options.up)
