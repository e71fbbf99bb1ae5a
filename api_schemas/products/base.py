"""What all kinds of products have in common on the wire."""

from enum import StrEnum

from pydantic import ConfigDict

from api_schemas.base import WireModel


class ProductKind(StrEnum):
    """What can be made of a fit."""

    TEXTURE = "texture"
    POSE = "pose"
    ANIMATION = "animation"
    CARICATURE = "caricature"
    PRINT = "print"
    SIZE = "size"
    COMPOSITION = "composition"


class BodyColours(StrEnum):
    """What a body wears: its picture with the light in it, the albedo found in it, or one colour.

    ``plain`` is one colour for each vertex, blurred over centimetres where shading was fitted, and
    else one for all.
    """

    PICTURE = "picture"
    ALBEDO = "albedo"
    PLAIN = "plain"


class ProductOptions(WireModel):
    """What is asked for."""

    @property
    def part(self) -> str | None:
        """The part of a form that may come along with the request; None where none may."""
        return None

    @property
    def part_is_for(self) -> str | None:
        """What the part is needed for, in words that go on from "which"; None if it is not."""
        return None


class ProductResult(WireModel):
    """What there is to say of a product besides its files."""

    # What is always answered is said to be: ``kind`` tells one from another.
    model_config = ConfigDict(json_schema_serialization_defaults_required=True)
