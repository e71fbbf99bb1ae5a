"""Notices of a fit's end, signed as Standard Webhooks has it."""

import base64
import binascii
from datetime import datetime
from enum import StrEnum
from typing import Annotated, Final

from pydantic import AfterValidator, Field

from api_schemas.base import WireModel, refusal
from api_schemas.jobs import Fit

SECRET_PREFIX: Final = "whsec_"
MIN_SECRET_BYTES: Final = 24
MAX_SECRET_BYTES: Final = 64


def secret_key(secret: str) -> bytes:
    """The key behind a secret as it is written.

    Raises
    ------
    PydanticCustomError
        If it is not ``whsec_`` and the base64 of 24 to 64 bytes.
    """
    try:
        if not secret.startswith(SECRET_PREFIX):
            raise binascii.Error
        key = base64.b64decode(secret.removeprefix(SECRET_PREFIX), validate=True)
    except binascii.Error:
        key = b""
    if not MIN_SECRET_BYTES <= len(key) <= MAX_SECRET_BYTES:
        raise refusal(
            code="unusable-secret",
            reason=f"A secret is '{SECRET_PREFIX}' and the base64 of {MIN_SECRET_BYTES} to "
            f"{MAX_SECRET_BYTES} random bytes.",
            remedy="Make one with: echo whsec_$(openssl rand -base64 32)",
        )
    return key


def _usable_secret(secret: str) -> str:
    secret_key(secret)
    return secret


class WebhookTarget(WireModel):
    """Where to send the notice of the fit's end.

    The address must be public: private, loopback and link-local ones are refused, ports other than
    443 and 80 as well, and redirects are not followed. Without a ``secret`` the service's own signs
    the notice; where it has none, a secret is needed.
    """

    url: str = Field(
        max_length=2_000,
        pattern=r"^https?://[^\s/?#@\\]+(?:[/?][^\s#]*)?$",
        examples=["https://example.org/hooks/maquette"],
        json_schema_extra={"format": "uri"},
    )
    secret: Annotated[str, AfterValidator(_usable_secret)] | None = Field(
        default=None,
        pattern=f"^{SECRET_PREFIX}(?:[A-Za-z0-9+/]{{4}}){{8,21}}(?:[A-Za-z0-9+/]{{4}}|"
        "[A-Za-z0-9+/]{3}=|[A-Za-z0-9+/]{2}==)?$",
        description=f"'{SECRET_PREFIX}' and the base64 of 24 to 64 bytes; never answered.",
        examples=["whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD"],
    )


class WebhookEventType(StrEnum):
    """How the fit ended."""

    SUCCEEDED = "fit.succeeded"
    FAILED = "fit.failed"
    CANCELED = "fit.canceled"
    TIMED_OUT = "fit.timed_out"


class WebhookEvent(WireModel):
    """The body of a notice.

    ``data`` is the fit as ``GET /v1/fits/{id}`` answers it after its end, which is at
    ``timestamp``. The body is the same at every attempt.
    """

    type: WebhookEventType
    timestamp: datetime
    data: Fit
