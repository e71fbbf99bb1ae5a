"""Tokens that a browser uses in place of an API key, for a short time and its own jobs alone."""

from datetime import datetime
from typing import Final

from pydantic import Field

from api_schemas.base import WholeNumber, WireModel
from api_schemas.labels import Label

LONGEST_LIFETIME_S: Final = 3_600
MOST_JOBS: Final = 100


class TokenRequest(WireModel):
    """What a token is to be good for."""

    lifetime_s: WholeNumber = Field(
        default=900,
        ge=60,
        le=LONGEST_LIFETIME_S,
        description="For how many seconds it is valid.",
    )
    jobs: WholeNumber = Field(
        default=10,
        ge=1,
        le=MOST_JOBS,
        description="How many fits, scans, derivations and retries it may have made.",
    )
    label: Label | None = Field(
        default=None,
        description=(
            "The label of all fits and scans made with it, whatever their requests say: what a "
            "browser sends can be changed by whoever sits there."
        ),
        examples=["customer-4711"],
    )


class NewToken(WireModel):
    """A token; it is shown this once."""

    id: str = Field(description="Names the token; it is no secret.")
    token: str = Field(description="To be sent as `Authorization: Bearer`.")
    expires_at: datetime
    jobs: int = Field(ge=1)
    label: str | None
