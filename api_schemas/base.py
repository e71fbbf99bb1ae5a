"""Common parts of all wire types."""

from typing import Annotated, LiteralString, cast

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field
from pydantic_core import PydanticCustomError


class WireModel(BaseModel):
    """Immutable, closed and strict: unknown fields, NaN and silent conversions are refused.

    Strict validation follows JSON's own types only through ``model_validate_json``; always parse
    the text, never an already decoded object.
    """

    model_config = ConfigDict(
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
        strict=True,
        ser_json_inf_nan="strings",
        hide_input_in_errors=True,
    )


def refusal(
    code: str, reason: str, *, remedy: str, field: str | None = None
) -> PydanticCustomError:
    """Build a validation error that carries its remedy, and its field where it is not the place.

    ``code`` is kebab-case, as it appears in a problem.
    """
    context = {"reason": reason, "remedy": remedy} | ({"field": field} if field else {})
    return PydanticCustomError(cast("LiteralString", code), "{reason}", context)


def _whole_number(value: object) -> object:
    # 2.0 is an integer in JSON Schema and a float to a strict validator: take JSON's side.
    return int(value) if isinstance(value, float) and value.is_integer() else value


WholeNumber = Annotated[int, BeforeValidator(_whole_number)]
"""An integer as JSON Schema understands it."""

# The bound stands before the validator, behind which no JSON Schema would say it.
Place = Annotated[int, Field(ge=0), BeforeValidator(_whole_number)]
"""A place in a list, counted from 0."""
