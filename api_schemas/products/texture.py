"""A texture: what is asked for, and what comes of it."""

from enum import StrEnum
from typing import Annotated, Final, Literal

from pydantic import AfterValidator, Field, WithJsonSchema

from api_schemas.base import WholeNumber, refusal
from api_schemas.products.base import ProductOptions, ProductResult

TEXTURE_SIZES: Final = (512, 1_024, 2_048)
"""Sides a texture may have, texels."""

LEAST_OWN_TEXTURE: Final = 64
"""Side of the smallest texture that may be sent; the largest is the last of those above."""


def _texture_size(size: int) -> int:
    if size in TEXTURE_SIZES:
        return size
    raise refusal(
        code="unknown-value",
        reason=f"A texture of {size} texels cannot be made.",
        remedy=f"Use {', '.join(map(str, TEXTURE_SIZES[:-1]))} or {TEXTURE_SIZES[-1]}.",
    )


class TextureColours(StrEnum):
    """The picture as it is, with its light, or the albedo found in it, to be lit anew.

    ``own`` are those of a painted atlas that comes along as the form's part ``texture``; they are
    taken for albedo.
    """

    PICTURE = "picture"
    ALBEDO = "albedo"
    OWN = "own"


class TextureOptions(ProductOptions):
    """The picture, or a texture of one's own, laid on the body; albedo needs a fit with shading."""

    kind: Literal["texture"]
    colours: TextureColours = TextureColours.PICTURE
    size: Annotated[
        WholeNumber,
        AfterValidator(_texture_size),
        WithJsonSchema({"type": "integer", "enum": list(TEXTURE_SIZES)}),
    ] = Field(
        default=1_024, description="Side of the texture, texels; one's own keeps the side it has."
    )

    @property
    def part(self) -> str | None:
        """A painted atlas comes along if the colours are one's own."""
        return "texture" if self.colours is TextureColours.OWN else None

    @property
    def part_is_for(self) -> str | None:
        """The colours come from it."""
        return None if self.part is None else "these colours are read from"


class TextureResult(ProductResult):
    """``body_textured.glb``, in the fitted pose, ``texture.png``, ``coverage.png``, ``atlas.png``.

    White texels of the coverage were seen in the picture, grey ones are taken from the other side
    of the body, black ones continued from their surroundings: these two kinds are invented. A
    texture of one's own has no coverage, and shares of nothing. An albedo may exceed 1: it is the
    texture's linear value times ``scale``.

    The atlas is a transparent drawing of the body's parts where the texture has them, with their
    names: a layer to paint under. Only what lies on the parts counts of what is painted; it is
    drawn on beyond their edges.
    """

    kind: Literal["texture"] = "texture"
    colours: TextureColours
    size: int
    seen_share: float = Field(ge=0.0, le=1.0, description="Of the body's texels.")
    mirrored_share: float = Field(ge=0.0, le=1.0, description="Of the body's texels.")
    scale: float
