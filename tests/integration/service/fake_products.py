"""What the simulated pipeline makes of a fit: results and files of some kinds, without numbers."""

from api_schemas.problems import FieldProblem
from api_schemas.products import AnyProductOptions
from api_schemas.products.base import BodyColours, ProductResult
from api_schemas.products.bodies import (
    AnimationOptions,
    AnimationResult,
    CaricatureOptions,
    CaricatureResult,
    PoseOptions,
    PoseResult,
    TextureOptions,
    TextureResult,
)
from api_schemas.products.documents import CompositionOptions, CompositionResult
from service.compute.tasks import Parts, UnusableInputError
from service.jobs.inputs import CLIP

LARGEST_FACTOR = 6.0
"""Of a caricature."""


def made_product(
    options: AnyProductOptions, parts: Parts
) -> tuple[ProductResult, dict[str, bytes]]:
    """What there is to say of the product, and its files."""
    match options:
        case CaricatureOptions(factor=factor) if factor > LARGEST_FACTOR:
            raise UnusableInputError(
                FieldProblem(
                    field="factor",
                    code="factor-unusable",
                    reason="The surface turns inside out.",
                    remedy=f"Send a factor from 0 to {LARGEST_FACTOR}.",
                    largest=LARGEST_FACTOR,
                )
            )
        case CaricatureOptions(factor=factor):
            result = CaricatureResult(
                factor=factor,
                coefficient=1,
                before=1.5,
                after=1.5 * factor,
                height_m=1.8,
                shape=(0.0, 1.5 * factor),
            )
            return result, {"body_caricature.glb": b"glTF"}
        case TextureOptions(colours=colours, size=size):
            result = TextureResult(
                colours=colours,
                size=size,
                seen_share=0.4,
                mirrored_share=0.1,
                scale=1.0,
            )
            return result, {"body_textured.glb": b"glTF", "texture.png": b"PNG"}
        case AnimationOptions():
            result = AnimationResult(
                source=parts.get(CLIP, b"a walk").decode()[:40],
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
            )
            return result, {"body_animated.glb": b"glTF"}
        case PoseOptions():
            result = PoseResult(pose={}, colours=BodyColours.PLAIN)
            return result, {"body_reposed.glb": b"glTF" + bytes(range(256)), "pose.png": b"PNG"}
        case CompositionOptions():
            result = CompositionResult(bmi=22.0, estimates=())
            return result, {"composition.csv": b"name,percent\r\n"}
        case other:
            message = f"the fake makes no {other.kind}"
            raise NotImplementedError(message)
