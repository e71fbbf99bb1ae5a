"""What is derived from a finished fit: a job of its own, by its kind."""

from typing import Annotated, Any, Final, cast

from pydantic import ConfigDict, Discriminator, RootModel

from api_schemas.derivation_kinds import AnyDerivationOptions, AnyDerivationResult, DerivationKind


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
