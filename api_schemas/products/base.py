"""Wire types common to all kinds of products."""

from enum import StrEnum

from pydantic import ConfigDict

from api_schemas.base import WireModel


class ProductKind(StrEnum):
    """Kind of product that can be made of a fit."""

    TEXTURE = "texture"
    POSE = "pose"
    ANIMATION = "animation"
    CARICATURE = "caricature"
    PRINT = "print"
    SIZE = "size"
    COMPOSITION = "composition"


class BodyColours(StrEnum):
    """Colours of a body: its picture with the light in it, the albedo found in it, or one colour.

    ``plain`` is one colour for each vertex, blurred over centimetres where shading was fitted, and
    else one for all.
    """

    PICTURE = "picture"
    ALBEDO = "albedo"
    PLAIN = "plain"


class ProductOptions(WireModel):
    """Options of a product."""

    @property
    def part(self) -> str | None:
        """The part of a form that may come along with the request; None where none may."""
        return None

    @property
    def part_is_for(self) -> str | None:
        """Purpose of the part, in words that go on from "which"; None if the part is not needed."""
        return None


class ProductResult(WireModel):
    """Facts about a product, besides its files."""

    # What is always answered is said to be: ``kind`` tells one from another.
    model_config = ConfigDict(json_schema_serialization_defaults_required=True)
