"""What all kinds of derivations have in common on the wire."""

from enum import StrEnum

from pydantic import ConfigDict

from api_schemas.base import WireModel
from api_schemas.results import ResultFile


class BodyColours(StrEnum):
    """What a body wears: its picture with the light in it, the albedo found in it, or one colour.

    ``plain`` is one colour for each vertex, blurred over centimetres where shading was fitted, and
    else one for all.
    """

    PICTURE = "picture"
    ALBEDO = "albedo"
    PLAIN = "plain"


class DerivationOptions(WireModel):
    """What all requests for a derivation have in common."""


class DerivedFiles(WireModel):
    """What all results of derivations have in common."""

    # What is always answered is said to be: ``kind`` tells one from another.
    model_config = ConfigDict(json_schema_serialization_defaults_required=True)

    files: tuple[ResultFile, ...]
