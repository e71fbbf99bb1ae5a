"""The body a fit would begin from: what clicks, gender, height and camera say without a picture."""

from typing import Final, Self

from pydantic import Field, model_validator

from api_schemas.base import WholeNumber, WireModel, refusal
from api_schemas.images import ImageId
from api_schemas.person import Person
from api_schemas.picture import (
    POINTS_DESCRIPTION,
    POINTS_EXAMPLE,
    LaidOut,
    Lens,
    Limb,
    LimbFacings,
)
from api_schemas.points import Points, PointsFormat
from api_schemas.results import Assumption, BodyResult, CameraResult, FitWarning
from fitter.vocabulary.choices import Facing, Gender
from fitter.vocabulary.outcomes import FocalLengthSource

MAX_SIDE: Final = 100_000


class ImageSize(WireModel):
    """Size of the picture as a browser shows it, pixels."""

    width: WholeNumber = Field(ge=1, le=MAX_SIDE, examples=[720])
    height: WholeNumber = Field(ge=1, le=MAX_SIDE, examples=[960])


class InitialPoseRequest(Person, Lens):
    """Who is in the picture, where the joints are, and the picture: uploaded, or its size alone."""

    points: Points = Field(description=f"{POINTS_DESCRIPTION}.", examples=[POINTS_EXAMPLE])
    format: LaidOut = PointsFormat.NAMED
    limb_facing: LimbFacings = Field(default_factory=dict[Limb, Facing])
    image_id: ImageId | None = None
    image_size: ImageSize | None = None

    @model_validator(mode="after")
    def _one_picture(self) -> Self:
        if (self.image_id is None) == (self.image_size is None):
            raise refusal(
                code="one-picture-needed",
                reason="Exactly one of image_id and image_size is needed.",
                field="image_size",
                remedy="Send the id of an uploaded picture, or the picture's width and height.",
            )
        return self


class LimbReading(WireModel):
    """Which way a limb faces in the best reading of the clicks.

    ``alternative_nats`` is by how much the best reading with the other facing is less likely (the
    difference of two negative log-likelihoods), null where there is none worth mentioning;
    ``ambiguous`` says that the clicks hardly tell the two apart: say which in ``limb_facing``.
    """

    limb: str
    facing: Facing
    ambiguous: bool
    alternative_nats: float | None


ImagePoint = tuple[float, float]


class InitialPose(WireModel):
    """The initial body, seen by its camera; pixels of the picture as a browser shows it.

    ``outline`` is closed lines round the body and the holes in it, to be filled by the even-odd
    rule. ``points`` are where the body has the points that can be clicked, ``residual_px`` how far
    from each click.
    """

    gender: Gender
    height_m: float
    camera: CameraResult
    focal_length_source: FocalLengthSource
    body: BodyResult
    outline: tuple[tuple[ImagePoint, ...], ...]
    points: dict[str, ImagePoint]
    residual_px: dict[str, float]
    limbs: tuple[LimbReading, ...]
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]
