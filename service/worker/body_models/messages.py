"""What the process that reads the body models says, as JSON on its standard output."""

from typing import Annotated, Final, Literal

from pydantic import Field, TypeAdapter

from api_schemas.base import WireModel
from api_schemas.body_models import BodyModels


class DescriptionMessage(WireModel):
    """The body models there are."""

    kind: Literal["description"] = "description"
    body_models: BodyModels


class UnusableModelsMessage(WireModel):
    """The body models cannot be used."""

    kind: Literal["unusable-models"] = "unusable-models"
    reason: str


ModelsMessage = Annotated[DescriptionMessage | UnusableModelsMessage, Field(discriminator="kind")]
MODELS_MESSAGES: Final[TypeAdapter[ModelsMessage]] = TypeAdapter(ModelsMessage)
