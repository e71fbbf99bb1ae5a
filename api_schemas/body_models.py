"""The trained bodies a service fits with."""

from pydantic import Field

from api_schemas.base import WireModel
from api_schemas.picture import Limb
from api_schemas.points import PointsFormat
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import LEAST_HEIGHT_M, MOST_HEIGHT_M
from fitter.vocabulary.points import POINT_NAMES


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
    point_formats: tuple[PointsFormat, ...] = tuple(PointsFormat)
    limbs: tuple[Limb, ...] = tuple(Limb)
    min_height_m: float = LEAST_HEIGHT_M
    max_height_m: float = MOST_HEIGHT_M
