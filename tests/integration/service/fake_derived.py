"""What the simulated pipeline derives: documents and files of each kind, without numbers."""

import json
from pathlib import Path

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivation_kinds.animation import AnimationOptions, AnimationResult
from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivation_kinds.caricature import CaricatureOptions, CaricatureResult
from api_schemas.derivation_kinds.texture import TextureColours, TextureOptions, TextureResult
from api_schemas.derivations import DerivationResult
from api_schemas.problems import FieldProblem
from api_schemas.results import FitResult
from service.api.openapi import recorded_examples
from service.jobs.inputs import (
    CLIP,
    IMAGE,
    RESULT,
    TEXTURE,
    of_view,
)
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
    UnusableInputError,
)

LARGEST_FACTOR = 6.0
"""Of a caricature."""

FILES = {
    ".csv": b"label,probability\r\n",
    ".glb": b"glTF",
    ".jpg": b"JPEG",
    ".png": b"PNG",
}


def derived_output(job: DerivationInput[AnyDerivationOptions]) -> DerivationOutput[DerivedFiles]:
    options = job.options
    if isinstance(options, CaricatureOptions):
        if options.factor > LARGEST_FACTOR:
            raise UnusableInputError(
                FieldProblem(
                    field="factor",
                    code="factor-unusable",
                    reason="The surface turns inside out.",
                    remedy=f"Send a factor from 0 to {LARGEST_FACTOR}.",
                    largest=LARGEST_FACTOR,
                )
            )
        result = CaricatureResult(
            factor=options.factor,
            coefficient=1,
            before=1.5,
            after=1.5 * options.factor,
            height_m=1.8,
            shape=(0.0, 1.5 * options.factor),
            files=(),
        )
        files = {"body_caricature.glb": b"glTF", "caricature.png": b"PNG"}
    elif isinstance(options, TextureOptions):
        # Who brings the colours has no copy of the picture.
        own = options.colours is TextureColours.OWN
        assert own is (TEXTURE in job.inputs) is (of_view(0, IMAGE) not in job.inputs)
        result = TextureResult(
            colours=options.colours,
            size=len(job.inputs[TEXTURE]) if own else options.size,
            seen_share=0.4,
            mirrored_share=0.1,
            scale=1.0,
            files=(),
        )
        files = {"body_textured.glb": b"glTF", "texture.png": b"PNG", "coverage.png": b"PNG"}
    elif isinstance(options, AnimationOptions):
        result = AnimationResult(
            source=job.inputs.get(CLIP, b"a walk").decode()[:40],
            frames=2,
            frame_time_s=0.04,
            morph_targets=1,
            morph_mean_error_mm=0.0,
            morph_largest_error_mm=0.0,
            skin_mean_error_mm=0.0,
            skin_largest_error_mm=0.0,
            sliding_mm=0.0,
            travelled_m=0.0,
            warnings=(),
            files=(),
        )
        files = {"body_animated.glb": b"glTF", "animation.webp": b"RIFF"}
    else:
        # Of any other kind what the OpenAPI document shows of it.
        if RESULT in job.inputs:
            FitResult.model_validate_json(job.inputs[RESULT])
        shown = recorded_examples()["answers"]["get_fit_derivation_result"]["200"][options.kind]
        result = DerivationResult.model_validate_json(json.dumps(shown)).root
        files = {each.name: FILES[Path(each.name).suffix] for each in result.files}
    return DerivationOutput(result=result, files=files)
