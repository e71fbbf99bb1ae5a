"""A texture: made of the picture, or of an atlas that comes along."""

from typing import Final

from api_schemas.derivation_kinds import AnyDerivationOptions, DerivationKind
from api_schemas.derivation_kinds.texture import (
    LEAST_OWN_TEXTURE,
    TEXTURE_SIZES,
    TextureColours,
    TextureOptions,
    TextureResult,
)
from api_schemas.problems import FieldProblem
from service.api.derivation_kinds.definition import DerivationKindDefinition, FormPart, Needs
from service.api.examples.files import files
from service.jobs.inputs import IMAGE, PERSON, SEGMENTATION, TEXTURE
from service.submissions.refusal import refused
from service.submissions.submission import check_picture


def _check(texture: bytes, options: AnyDerivationOptions, max_pixels: int) -> str:
    """Check a painted atlas by its header alone; returns its media type."""
    del options
    header = check_picture(TEXTURE, texture, max_pixels=max_pixels)
    largest = TEXTURE_SIZES[-1]
    reason = None
    if header.width != header.height:
        reason = "is not square, as the atlas is"
    elif not LEAST_OWN_TEXTURE <= header.width <= largest:
        reason = f"is not between {LEAST_OWN_TEXTURE} and {largest} texels a side"
    if reason is not None:
        raise refused(
            FieldProblem(
                field=TEXTURE,
                code="texture-size",
                reason=f"The texture, {header.width} x {header.height}, {reason}.",
                remedy=f"Paint on atlas.png of any texture of this fit, or scale to {largest} x "
                f"{largest}.",
            )
        )
    return header.media_type


ATLAS: Final = FormPart(
    name=TEXTURE,
    description=(
        "A painted atlas, square, in the layout of `atlas.png` of any texture of the fit: JPEG, "
        "PNG or WebP, for colours `own`."
    ),
    media_types="image/jpeg, image/png, image/webp, image/heic",
    sent_for="a texture with colours 'own'",
    check=_check,
)


def _needs(options: TextureOptions) -> Needs:
    if options.colours is not TextureColours.OWN:
        return Needs(of_fit=(PERSON, IMAGE, SEGMENTATION))
    # Who brings the colours needs none of the picture's.
    return Needs(of_fit=(PERSON,), part=ATLAS, part_is_for="these colours are read from")


KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.TEXTURE,
    options=TextureOptions,
    result=TextureResult,
    needs=_needs,
    part=ATLAS,
    requests={"texture": {"kind": "texture", "colours": "albedo", "size": 2048}},
    answer={
        "artifacts": files(
            body_textured__glb=2874000,
            texture__png=1980000,
            coverage__png=21000,
            atlas__png=73000,
        ),
        "kind": "texture",
        "colours": "albedo",
        "size": 2048,
        "seen_share": 0.38,
        "mirrored_share": 0.09,
        "scale": 1.0,
    },
)
