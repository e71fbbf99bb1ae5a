"""A body in motion: made of the person, and of a motion if one comes along."""

import codecs
from typing import Final

from api_schemas.derivation_kinds import AnyDerivationOptions, DerivationKind
from api_schemas.derivation_kinds.animation import AnimationOptions, AnimationResult
from api_schemas.problems import FieldProblem, problem
from service.api.derivation_kinds.definition import DerivationKindDefinition, FormPart, Needs
from service.api.examples.files import files
from service.jobs.inputs import CLIP, PERSON
from service.submissions.refusal import RefusedError, refused

MAX_CLIP_BYTES: Final = 32 * 1024 * 1024
"""What the fitter reads at most; a minute of motion capture is a tenth of it."""


def _check(clip: bytes, options: AnyDerivationOptions, max_pixels: int) -> str:
    """Check what can be told of a BVH file without reading it."""
    del options, max_pixels
    if len(clip) > MAX_CLIP_BYTES:
        raise RefusedError(
            problem(
                "payload-too-large",
                field=CLIP,
                detail=f"The motion has {len(clip)} bytes, more than {MAX_CLIP_BYTES}.",
                remedy="Cut the clip, or lower its frame rate.",
            )
        )
    if not clip.removeprefix(codecs.BOM_UTF8).lstrip()[:9].upper() == b"HIERARCHY":
        raise refused(
            FieldProblem(
                field=CLIP,
                code="not-a-bvh",
                reason="The motion does not begin with HIERARCHY: it is no BVH file.",
                remedy="Export the motion as BVH.",
            )
        )
    return "text/plain"


BVH: Final = FormPart(
    name=CLIP,
    description=(
        "A motion as a BVH file, of a skeleton with the joint names of CMU, Mixamo, Rokoko or "
        "Blender."
    ),
    media_types="text/plain, application/octet-stream",
    sent_for="an animation",
    check=_check,
)

KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.ANIMATION,
    options=AnimationOptions,
    result=AnimationResult,
    needs=lambda _: Needs(of_fit=(PERSON,), part=BVH),
    part=BVH,
    of_scans=True,
    requests={"walk": {"kind": "animation"}},
    answer={
        "artifacts": files(body_animated__glb=4321000, animation__webp=151000),
        "kind": "animation",
        "source": "the walk that ships with the package",
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
