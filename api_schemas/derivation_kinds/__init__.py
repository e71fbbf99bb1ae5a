"""What can be made of a fit, on the wire: one module a kind, with its options and its result."""

from enum import StrEnum
from typing import Annotated

from pydantic import Tag

from api_schemas.derivation_kinds.animation import AnimationOptions, AnimationResult
from api_schemas.derivation_kinds.body_composition import (
    BodyCompositionOptions,
    BodyCompositionResult,
)
from api_schemas.derivation_kinds.caricature import CaricatureOptions, CaricatureResult
from api_schemas.derivation_kinds.pose import PoseOptions, PoseResult
from api_schemas.derivation_kinds.size import SizeOptions, SizeResult
from api_schemas.derivation_kinds.texture import TextureOptions, TextureResult


class DerivationKind(StrEnum):
    """What can be made of a fit."""

    CARICATURE = "caricature"
    POSE = "pose"
    ANIMATION = "animation"
    TEXTURE = "texture"
    SIZE = "size"
    BODY_COMPOSITION = "body_composition"


AnyDerivationOptions = (
    Annotated[CaricatureOptions, Tag("[caricature]")]
    | Annotated[PoseOptions, Tag("[pose]")]
    | Annotated[AnimationOptions, Tag("[animation]")]
    | Annotated[TextureOptions, Tag("[texture]")]
    | Annotated[SizeOptions, Tag("[size]")]
    | Annotated[BodyCompositionOptions, Tag("[body_composition]")]
)
"""What is asked for. The tag is the kind in brackets."""

AnyDerivationResult = (
    Annotated[CaricatureResult, Tag("[caricature]")]
    | Annotated[PoseResult, Tag("[pose]")]
    | Annotated[AnimationResult, Tag("[animation]")]
    | Annotated[TextureResult, Tag("[texture]")]
    | Annotated[SizeResult, Tag("[size]")]
    | Annotated[BodyCompositionResult, Tag("[body_composition]")]
)
"""What came of it."""
