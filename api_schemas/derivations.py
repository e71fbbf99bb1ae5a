"""What is derived from a finished fit: a job of its own, by its kind."""

from datetime import datetime
from enum import StrEnum
from typing import Annotated, Any, Final, cast
from uuid import UUID

from pydantic import ConfigDict, Discriminator, Field, RootModel

from api_schemas.base import WireModel
from api_schemas.derivation_kinds import AnyDerivationOptions, AnyDerivationResult, DerivationKind
from api_schemas.jobs import JobStanding, ResourceLinks


def _kind(value: Any) -> str | None:
    # In brackets, by which field names of problems leave the alternative out.
    is_object = isinstance(value, dict)
    kind = cast("dict[str, Any]", value).get("kind") if is_object else getattr(value, "kind", None)
    return f"[{kind}]" if isinstance(kind, str) else None


_KINDS: Final = ", ".join(f"'{kind}'" for kind in DerivationKind)
BY_KIND: Final = Discriminator(
    _kind,
    custom_error_type="unknown-value",
    custom_error_message="{reason}",
    custom_error_context={
        "field": "kind",
        "reason": "The request does not say what is to be derived.",
        "remedy": f"Send as kind one of {_KINDS}.",
    },
)


class DerivationRequest(RootModel[Annotated[AnyDerivationOptions, BY_KIND]]):
    """What to derive from a fit; ``kind`` says which fields there are."""

    model_config = ConfigDict(frozen=True, strict=True, hide_input_in_errors=True)


class DerivationResult(RootModel[Annotated[AnyDerivationResult, BY_KIND]]):
    """``result.json`` of a derivation; ``kind`` says which fields there are."""

    model_config = ConfigDict(frozen=True, strict=True)


class DerivationLinks(ResourceLinks):
    """Paths of a derivation's resources below this service's root; absent ones are not (yet)."""

    fit: str = Field(description="The fit it is derived from.")


class Derivation(JobStanding):
    """One accepted derivation; it is erased with its fit, and expires when the fit does."""

    kind: DerivationKind
    fit_id: UUID
    links: DerivationLinks


class DerivationPage(WireModel):
    """Derivations of a fit, newest first; ``next`` is the path of the following page."""

    derivations: tuple[Derivation, ...]
    next: str | None


class DerivationEventType(StrEnum):
    """How the job ended."""

    SUCCEEDED = "derivation.succeeded"
    FAILED = "derivation.failed"
    CANCELED = "derivation.canceled"
    TIMED_OUT = "derivation.timed_out"


class DerivationEvent(WireModel):
    """The body of a notice.

    ``data`` is the derivation as its own path answers it, but for ``webhook``, which is null.
    ``timestamp`` is when the job ended.
    """

    type: DerivationEventType
    timestamp: datetime
    data: Derivation
