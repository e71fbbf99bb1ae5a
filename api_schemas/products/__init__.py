"""Products: files that are functions of a finished fit, made when they are asked for.

``bodies`` and ``documents`` hold options and result of each kind; a kind that is added has a line
in each of the two lists here.
"""

import hashlib
import json
from typing import Annotated, Any, Final, cast
from uuid import UUID

from pydantic import ConfigDict, Discriminator, Field, RootModel, Tag, TypeAdapter

from api_schemas.base import WireModel
from api_schemas.jobs import JobState
from api_schemas.problems import Problem
from api_schemas.products.base import ProductKind, ProductOptions
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
from api_schemas.products.documents import (
    CompositionOptions,
    CompositionResult,
    PrintOptions,
    PrintResult,
    SizeOptions,
    SizeResult,
)

# A tag is the kind in brackets, by which field names of problems leave the alternative out.
AnyProductOptions = (
    Annotated[TextureOptions, Tag("[texture]")]
    | Annotated[PoseOptions, Tag("[pose]")]
    | Annotated[AnimationOptions, Tag("[animation]")]
    | Annotated[CaricatureOptions, Tag("[caricature]")]
    | Annotated[PrintOptions, Tag("[print]")]
    | Annotated[SizeOptions, Tag("[size]")]
    | Annotated[CompositionOptions, Tag("[composition]")]
)
"""Options of a product of any kind."""

AnyProductResult = Annotated[
    TextureResult
    | PoseResult
    | AnimationResult
    | CaricatureResult
    | PrintResult
    | SizeResult
    | CompositionResult,
    Field(discriminator="kind"),
]
"""Result of a product of any kind."""


def _tag(value: Any) -> str | None:
    is_object = isinstance(value, dict)
    kind = cast("dict[str, Any]", value).get("kind") if is_object else getattr(value, "kind", None)
    return f"[{kind}]" if isinstance(kind, str) else None


_BY_KIND: Final = Discriminator(
    _tag,
    custom_error_type="unknown-value",
    custom_error_message="{reason}",
    custom_error_context={
        "field": "kind",
        "reason": "The request does not say what is to be made.",
        "remedy": f"Send as kind one of {', '.join(map(repr, map(str, ProductKind)))}.",
    },
)


class ProductRequest(RootModel[Annotated[AnyProductOptions, _BY_KIND]]):
    """Product to make of a fit; ``kind`` says which fields there are."""

    model_config = ConfigDict(frozen=True, strict=True, hide_input_in_errors=True)


class ProductLinks(WireModel):
    """Paths of a product's resources below this service's root."""

    self: str
    fit: str
    files: dict[str, str] = Field(description="By name, once it has succeeded.")


class Product(WireModel):
    """Files that are made of a fit; they are erased with it."""

    id: str = Field(
        pattern="^[0-9a-f]{32}$",
        description="A digest of what was asked for: of one fit the same is made once.",
    )
    kind: ProductKind
    fit_id: UUID
    state: JobState
    progress: float = Field(ge=0.0, le=1.0, description="The share of the work that is done.")
    problem: Problem | None = Field(description="Why there is no result; null unless it failed.")
    result: AnyProductResult | None = Field(
        description="What there is to say of the files; null until it has succeeded."
    )
    links: ProductLinks


def product_id(options: ProductOptions, part: bytes | None) -> str:
    """Digest what is asked for: the options as understood, and the part that came with them."""
    understood = json.dumps(options.model_dump(mode="json"), sort_keys=True)
    digest = hashlib.sha256(understood.encode())
    if part is not None:
        digest.update(hashlib.sha256(part).digest())
    return digest.hexdigest()[:32]


_RESULT: Final = TypeAdapter[AnyProductResult](AnyProductResult)


def product_result(document: bytes) -> AnyProductResult:
    """Read what is stored of what there is to say of a product."""
    return _RESULT.validate_json(document, strict=True)
