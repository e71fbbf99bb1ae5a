"""Tokens that a browser uses in place of an API key, for a short time and its own jobs alone."""

from datetime import datetime
from typing import Annotated, Final

from pydantic import Field

from api_schemas.base import WholeNumber, WireModel
from api_schemas.labels import Label

LONGEST_LIFETIME_S: Final = 3_600
MOST_JOBS: Final = 100
IMAGES_OF_JOB: Final = 12
"""So many uploaded pictures may be kept with a token for each of its jobs: six, and their masks."""

TokenId = Annotated[
    str,
    Field(
        pattern="^[0-9a-f]{16}$",
        description="As `POST /v1/tokens` answered it.",
        examples=["5b8f0d3c2a917e64"],
    ),
]


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
        description=(
            "How many fits, scans, derivations and retries it may have made. For each of them "
            f"{IMAGES_OF_JOB} uploaded pictures may be kept at a time."
        ),
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


class Token(WireModel):
    """A token that is valid, without its text."""

    id: TokenId
    key_id: str = Field(
        description="The key it was made with: the part between the underscores; it is no secret."
    )
    label: str | None
    created_at: datetime
    expires_at: datetime
    jobs: int = Field(ge=1, description="How many jobs it is good for in all.")
    jobs_left: int = Field(ge=0, description="How many of them it may still have made.")
    images: int = Field(ge=0, description="How many uploaded pictures are kept with it.")
    most_images: int = Field(ge=1, description="How many may be.")


class TokenPage(WireModel):
    """Tokens, newest first; ``next`` is the path of the following page."""

    tokens: tuple[Token, ...]
    next: str | None
