"""What the health endpoints answer."""

from typing import Literal

from api_schemas.base import WireModel


class Live(WireModel):
    """The process answers."""

    status: Literal["live"] = "live"


class Ready(WireModel):
    """The service can accept and finish a fit: database writable, disk free, a worker able."""

    status: Literal["ready"] = "ready"
    workers: int
    queued: int
