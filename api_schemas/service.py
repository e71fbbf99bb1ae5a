"""What the service says of itself: its root and its health."""

from typing import Literal

from pydantic import Field

from api_schemas.base import WireModel


class ServiceIndex(WireModel):
    """The service's name, version and ways in; ``links`` are paths below its root."""

    name: str
    version: str
    links: dict[str, str]
    retention_hours: float | None = Field(
        default=None,
        description=(
            "Hours after which a picture that is no longer used, and a job that has ended, are "
            "erased."
        ),
    )
    max_pixels: int | None = Field(
        default=None, description="Pixels of the largest picture accepted."
    )
    max_upload_bytes: int | None = Field(
        default=None, description="Bytes of the largest request accepted."
    )


class Live(WireModel):
    """The process answers."""

    status: Literal["live"] = "live"


class Ready(WireModel):
    """The service can accept and finish a fit: database writable, disk free, a worker able."""

    status: Literal["ready"] = "ready"
    workers: int
    queued: int
