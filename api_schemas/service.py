"""The service's description of itself: its root, its health, its body models."""

from typing import Literal

from pydantic import Field

from api_schemas.base import WireModel
from api_schemas.picture import Limb
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import LEAST_HEIGHT_M, MOST_HEIGHT_M
from fitter.vocabulary.points import POINT_NAMES


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


class Health(WireModel):
    """The process answers, or can also accept and finish a fit: ``live`` or ``ready``.

    Ready is a service whose database is writable, with room on the disk and a worker that is able.
    """

    status: Literal["live", "ready"]
    workers: int | None = Field(default=None, description="That are able; null of `live`.")
    queued: int | None = Field(default=None, description="Jobs that wait; null of `live`.")


class BodyModelInfo(WireModel):
    """One trained body."""

    gender: Gender
    mean_height_m: float = Field(description="Assumed when a request names no height.")
    vertices: int
    triangles: int
    shape_coefficients: int
    parts: tuple[str, ...]
    landmarks: tuple[str, ...]
    format_version: int
    checksum: str
    sources: tuple[str, ...]
    licences: tuple[str, ...]


class BodyModels(WireModel):
    """The bodies, and what a request about them may say."""

    models: tuple[BodyModelInfo, ...]
    points: tuple[str, ...] = POINT_NAMES
    limbs: tuple[Limb, ...] = tuple(Limb)
    min_height_m: float = LEAST_HEIGHT_M
    max_height_m: float = MOST_HEIGHT_M
