"""Uploaded pictures, and what a request says of one: view, points, lens, clothes, light."""

from datetime import datetime
from enum import StrEnum
from typing import Annotated, Any, Final, Literal, Self

from pydantic import Discriminator, Field, Tag, model_validator

from api_schemas.base import WireModel, refusal
from api_schemas.points import AUTO, Points, PointsOrAuto
from fitter.vocabulary.choices import Clothing, Facing, LightKind, ViewKind

LEAST_SIDE_PX: Final = 64
LARGEST_ASPECT_RATIO: Final = 20.0

ImageId = Annotated[
    str,
    Field(
        pattern="^[0-9a-f]{64}$",
        description="SHA-256 of the file, as `POST /v1/images` answered it.",
        examples=["0f7cfbdf3dcb0c9ac2e2b8f1f1c4f3a63f1a1b7f0e2a5d4c3b2a19080706f5e4"],
    ),
]


class UploadedImage(WireModel):
    """An uploaded picture; the same bytes always have the same id.

    ``width`` and ``height`` are those a browser shows (EXIF orientation applied), in which points
    are counted.
    """

    id: ImageId
    media_type: str
    width: int
    height: int
    size: int = Field(description="Bytes.")
    focal_length_35mm: float | None = Field(
        description="The 35 mm equivalent its EXIF data name; null where they name none."
    )
    created_at: datetime
    expires_at: datetime | None = Field(description="When it is erased; null if it is kept.")


class ImagePage(WireModel):
    """Uploaded pictures, newest first; ``next`` is the path of the following page."""

    images: tuple[UploadedImage, ...]
    next: str | None


POINTS_DESCRIPTION: Final = (
    "Clicked points, pixels of the picture as a browser shows it. At least four of the "
    "shoulders, elbows, wrists, hips, knees and ankles, two of them shoulders or hips"
)
POINTS_EXAMPLE: Final[dict[str, Any]] = {
    "left_shoulder": [438.5, 222.0],
    "right_shoulder": [249.0, 222.0],
    "left_elbow": [484.0, 346.0],
    "left_hip": [399.0, 460.0],
    "right_hip": [296.0, 453.0],
    "right_knee": [295.0, 641.0, 2],
}


class Limb(StrEnum):
    """Limbs whose facing a caller may state."""

    TORSO = "torso"
    LEFT_UPPER_ARM = "left_upper_arm"
    LEFT_FOREARM = "left_forearm"
    RIGHT_UPPER_ARM = "right_upper_arm"
    RIGHT_FOREARM = "right_forearm"
    LEFT_THIGH = "left_thigh"
    LEFT_SHIN = "left_shin"
    RIGHT_THIGH = "right_thigh"
    RIGHT_SHIN = "right_shin"


LimbFacings = Annotated[
    dict[Limb, Facing],
    Field(description="Which limbs point toward the camera, which away."),
]


class Lens(WireModel):
    """At most one focal length; without one the picture's EXIF data are asked."""

    focal_length_px: float | None = Field(
        default=None, gt=0.0, le=1_000_000.0, description="Focal length in pixels of the picture."
    )
    focal_length_35mm: float | None = Field(
        default=None, ge=5.0, le=5_000.0, description="Focal length in 35 mm equivalent."
    )

    @model_validator(mode="after")
    def _one_focal_length(self) -> Self:
        if self.focal_length_px is not None and self.focal_length_35mm is not None:
            raise refusal(
                code="two-focal-lengths",
                reason="Both focal_length_px and focal_length_35mm are given.",
                field="focal_length_35mm",
                remedy="Send one of the two.",
            )
        return self


class Light(WireModel):
    """The light: in a request a coarse first guess, in a result the one found.

    Azimuth 0 and elevation 0 is a light at the camera's side of the body; positive azimuth comes
    from the right of the picture, positive elevation from above. The distance is that from the
    body's centre; a directional light has none.
    """

    kind: LightKind = LightKind.POINT
    azimuth_deg: float | None = Field(default=None, ge=-180.0, le=180.0)
    elevation_deg: float | None = Field(default=None, ge=-90.0, le=90.0)
    distance_m: float | None = Field(default=None, gt=0.0, le=100.0)


class ClothingByRegion(WireModel):
    """Clothes on trunk and arms, and on seat and legs."""

    upper: Clothing = Clothing.AUTO
    lower: Literal[Clothing.AUTO, Clothing.TIGHT, Clothing.LOOSE] = Clothing.AUTO


def _clothing_kind(value: object) -> str:
    return "[all]" if isinstance(value, str) else "[regions]"


SaidClothing = Annotated[
    Annotated[Clothing, Tag("[all]")] | Annotated[ClothingByRegion, Tag("[regions]")],
    Discriminator(_clothing_kind),
]


class ViewRequest(Lens):
    """One picture: from where it shows the person, its points, its lens, how it is read."""

    view: ViewKind | None = Field(
        default=None,
        description=(
            "From where the picture shows the person, if it was taken to be measured: who is so "
            "pictured stands upright and still. Needed where there are several pictures; of one "
            "nothing is presumed where it is left out."
        ),
    )
    points: PointsOrAuto = Field(
        default=AUTO,
        description=(
            f"{POINTS_DESCRIPTION}, unless `complete_points` is set. `auto`: all are proposed, of "
            "the largest person in the picture. Needs the detector."
        ),
        examples=[POINTS_EXAMPLE, AUTO],
    )
    complete_points: bool = Field(
        default=False,
        description=(
            "Have a detector propose the points that are not given; those that are stay as they "
            "are, and one is enough to say who of several people is meant. Needs the detector."
        ),
    )
    limb_facing: LimbFacings = Field(default_factory=dict[Limb, Facing])
    clothing: SaidClothing = Field(
        default=Clothing.AUTO,
        description=(
            "How clothes lie on the whole person, or on the upper body and on the lower; `outer`: "
            "a jacket or open shirt over a top. Give the weight if it is known."
        ),
        examples=["loose", {"upper": "outer", "lower": "tight"}],
    )
    light: Light = Field(default=Light(), description="Where about the light is.")
    image_id: ImageId | None = Field(
        default=None, description="The uploaded picture, where none comes with the request."
    )
    mask_id: ImageId | None = Field(
        default=None,
        description=(
            "A grey picture of the same size, uploaded too; the person is brighter than half."
        ),
    )

    @property
    def are_points_completed(self) -> bool:
        """Whether points that are not given are to be proposed."""
        return self.complete_points or self.points == AUTO

    @property
    def given_points(self) -> Points:
        """The points that were given: none where all are to be proposed."""
        return {} if isinstance(self.points, str) else self.points
