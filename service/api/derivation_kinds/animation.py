"""A body in motion: made of the person, and of a motion if one comes along."""

from typing import Final

from api_schemas.derivation_kinds import AnyDerivationOptions, DerivationKind
from api_schemas.derivation_kinds.animation import AnimationOptions, AnimationResult
from api_schemas.problems import FieldProblem, problem
from fitter.applications.bvh import MAX_BYTES
from fitter.applications.motion_file import read_motion
from fitter.errors import InvalidInputError
from service.api.derivation_kinds.definition import DerivationKindDefinition, FormPart, Needs
from service.api.examples.files import files
from service.jobs.inputs import CLIP, PERSON
from service.submissions.refusal import RefusedError, refused


def _check(clip: bytes, options: AnyDerivationOptions, max_pixels: int) -> str:
    """Read a BVH file: whatever the job would refuse is refused now, in the same words."""
    del max_pixels
    if len(clip) > MAX_BYTES:
        raise RefusedError(
            problem(
                "payload-too-large",
                field=CLIP,
                detail=f"The motion has {len(clip)} bytes, more than {MAX_BYTES}.",
                remedy="Cut the clip, or lower its frame rate.",
            )
        )
    if isinstance(options, AnimationOptions):
        try:
            read_motion(clip, named=options.joints, start_s=options.start_s)
        except InvalidInputError as error:
            raise refused(
                FieldProblem(
                    field=error.field, code=error.code, reason=error.reason, remedy=error.remedy
                )
            ) from error
    return "text/plain"


BVH: Final = FormPart(
    name=CLIP,
    description=(
        "A motion as a BVH file. Joints are known by the names of many programs, such as CMU, "
        "Mixamo, Biovision, SMPL or Unreal; `joints` names them otherwise. Its rest pose does not "
        "matter."
    ),
    media_types="text/plain, application/octet-stream",
    sent_for="an animation",
    check=_check,
)

KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.ANIMATION,
    options=AnimationOptions,
    result=AnimationResult,
    needs=lambda options: Needs(
        of_fit=(PERSON,),
        part=BVH,
        part_is_for="`joints` and `up` are about" if options.joints or options.up else None,
    ),
    part=BVH,
    requests={
        "walk": {"kind": "animation"},
        "own names": {
            "kind": "animation",
            "joints": {"left_thigh": "Oberschenkel_L", "right_thigh": "Oberschenkel_R"},
            "up": "z",
        },
    },
    answer={
        "artifacts": files(body_animated__glb=4321000, animation__webp=151000),
        "kind": "animation",
        "source": "the walk that ships with the package",
        "up": None,
        "frames": 99,
        "frame_time_s": 0.0334,
        "morph_targets": 12,
        "morph_mean_error_mm": 0.4,
        "morph_largest_error_mm": 2.9,
        "skin_mean_error_mm": 3.1,
        "skin_largest_error_mm": 41.0,
        "sliding_mm": 0.6,
        "travelled_m": 4.1,
        "warnings": [],
    },
)
