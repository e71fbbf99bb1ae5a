"""What a caller asks for: a fit, of a picture sent along or uploaded before."""

from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Annotated, Any, Final, Self

from pydantic import Field, WithJsonSchema, model_validator

from api_schemas.base import WireModel, refusal
from api_schemas.images import ImageId
from api_schemas.known import KnownMeasurements
from api_schemas.labels import LABEL_OF_JOB, Label
from api_schemas.lens import Lens
from api_schemas.points import AUTO, Point, Points, PointsFormat, PointsOrAuto
from api_schemas.webhooks import WebhookTarget
from fitter.vocabulary.choices import (
    Clothing,
    Cues,
    Facing,
    Gender,
    LightKind,
    OptimizerKind,
    PaperEnergy,
    SegmentationKind,
    ViewKind,
)
from fitter.vocabulary.points import PointName


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


class LightGuess(WireModel):
    """A coarse first guess of the light, refined by the fit.

    Azimuth 0 and elevation 0 is a light at the camera's side of the body; positive azimuth comes
    from the right of the picture, positive elevation from above.
    """

    kind: LightKind = LightKind.POINT
    azimuth_deg: float | None = Field(default=None, ge=-180.0, le=180.0)
    elevation_deg: float | None = Field(default=None, ge=-90.0, le=90.0)
    distance_m: float | None = Field(default=None, gt=0.0, le=100.0)


_POINTS_DESCRIPTION: Final = (
    "Clicked points, pixels of the picture as a browser shows it. At least four of the "
    "shoulders, elbows, wrists, hips, knees and ankles, two of them shoulders or hips{unless}."
)
_POINTS_EXAMPLE: Final = {
    "left_shoulder": [438.5, 222.0],
    "right_shoulder": [249.0, 222.0],
    "left_elbow": [484.0, 346.0],
    "left_hip": [399.0, 460.0],
    "right_hip": [296.0, 453.0],
    "right_knee": {"x": 295, "y": 641, "visibility": 2},
}


class Person(KnownMeasurements):
    """Who is in the pictures."""

    gender: Gender = Field(description="Which body model is fitted.")


class PictureFacts(Lens):
    """Through which lens a picture was taken, and what its points are."""

    format: PointsFormat = Field(
        default=PointsFormat.NAMED, description="Whose points they are: another's are lists."
    )
    limb_facing: dict[Limb, Facing] = Field(
        default_factory=dict[Limb, Facing],
        description="Which limbs point toward the camera, which away.",
    )


class SubjectOptions(PictureFacts, Person):
    """Who is in the picture, where the joints are, and through which lens it was taken.

    The body has the height, the weight and the measurements that are given. ``height_m`` left out
    means the mean of the gender, or the most probable height of people with the given measurements;
    the answer then lists it as assumed. At most one focal length; without one the picture's EXIF
    data are asked.
    """

    points: Points = Field(
        description=_POINTS_DESCRIPTION.format(unless=""), examples=[_POINTS_EXAMPLE]
    )


class ClothingByRegion(WireModel):
    """How clothes lie on trunk and arms, and on seat and legs."""

    upper: Clothing = Clothing.AUTO
    lower: Clothing = Clothing.AUTO


_CLOTHING_READ_BACK: Final = {"type": "string", "enum": ["tight", "loose"]}


def _without_unsaid_default(schema: dict[str, Any]) -> None:
    """``auto``, the default, is left out of a request that is read back."""
    if schema.get("enum") == _CLOTHING_READ_BACK["enum"]:
        schema.pop("default", None)


class PictureChoices(WireModel):
    """How a picture is read."""

    complete_points: bool = Field(
        default=False,
        description=(
            "Have a detector propose the points that are not given; those that are stay as they "
            "are, and one is enough to say who of several people is meant. Needs the detector."
        ),
    )
    # What is stored for a worker of an earlier version says nothing that it does not know.
    clothing: Annotated[
        Clothing,
        WithJsonSchema(_CLOTHING_READ_BACK, mode="serialization"),
    ] = Field(
        default=Clothing.AUTO,
        exclude_if=lambda clothing: clothing is Clothing.AUTO,
        json_schema_extra=_without_unsaid_default,
        description=(
            "How clothes lie on the whole person. Give the weight if it is known. A request that "
            "is read back leaves `auto` out."
        ),
    )
    clothing_by_region: ClothingByRegion | None = Field(
        default=None,
        exclude_if=lambda by_region: by_region is None,
        description="In place of `clothing`: what lies how on the upper body, and on the lower.",
        examples=[{"upper": "loose", "lower": "tight"}],
    )
    segmentation: SegmentationKind = Field(
        default=SegmentationKind.SEEDED_GRABCUT,
        description=(
            "How the person is cut out where no mask is sent: from the detector's mask, where the "
            "service has a detector and it finds the person, or from the points' bones alone."
        ),
    )
    slant_hints: bool = Field(
        default=True,
        description=(
            "Have the detector, where the service has one, say how limbs slant in depth; "
            "`limb_facing` goes before it."
        ),
    )
    light: LightGuess = Field(default=LightGuess(), description="Where about the light is.")


Force = Annotated[
    bool,
    Field(
        description=(
            "Give measurements even if the verdict is `implausible` or `no_person`; otherwise they "
            "are withheld."
        ),
    ),
]


class PaperMethod(WireModel):
    """The paper's own method: its energies alone, in the tri-map of the first body."""

    energies: tuple[PaperEnergy, ...] = Field(
        default=tuple(PaperEnergy),
        min_length=1,
        max_length=len(PaperEnergy),
        description="The terms that count.",
    )
    free_height: bool = Field(default=False, description="Find the height too.")


class PersonChoices(Person):
    """Who is in the pictures, and what to do."""

    cues: Cues = Field(
        default=Cues.SES, description="`SE`: silhouette and edges; `SES`: shading too."
    )
    optimizer: OptimizerKind = Field(
        default=OptimizerKind.GAUSS_NEWTON,
        description="`simplex` is the paper's, and takes minutes.",
    )
    force: Force = False


class FitChoices(PictureChoices, PictureFacts, PersonChoices):
    """Who is in the picture, how it is read, and what to do."""

    # What is stored for a worker of an earlier version says nothing that it does not know.
    view: ViewKind | None = Field(
        default=None,
        exclude_if=lambda view: view is None,
        description=(
            "From where the picture shows the person, if it was taken to be measured: who is so "
            "pictured stands upright and still. Nothing is presumed of other pictures, where "
            "it is left out."
        ),
    )
    paper: PaperMethod | None = Field(
        default=None,
        exclude_if=lambda paper: paper is None,
        description="Fit as the paper does; the result's `differences` say what is not as there.",
    )


class FitOptions(FitChoices, SubjectOptions):
    """One fit, as it was understood: points are named, and none where all are to be proposed."""

    @property
    def pictures(self) -> tuple[Self]:
        """What is asked of its only picture."""
        return (self,)


AskedPoints = Annotated[
    PointsOrAuto,
    Field(
        description=(
            _POINTS_DESCRIPTION.format(unless=", unless `complete_points` is set")
            + " `auto`: all are proposed, of the largest person in the picture. Needs the detector."
        ),
        examples=[_POINTS_EXAMPLE, AUTO],
    ),
]


class AskedPicture(PictureChoices, PictureFacts):
    """What is asked of a picture, points included."""

    points: AskedPoints

    @property
    def are_points_completed(self) -> bool:
        """Whether points that are not given are to be proposed."""
        return self.complete_points or self.points == AUTO

    def named(self, points: Mapping[PointName, Point]) -> dict[str, Any]:
        """The values that its points have once they are understood to be these."""
        return {
            "points": dict(points),
            "format": PointsFormat.NAMED,
            "complete_points": self.are_points_completed,
        }


class FitRequest(AskedPicture, FitChoices):
    """The JSON part ``request`` of a submission: the fit, and whom to tell of its end."""

    label: Label | None = Field(default=None, description=LABEL_OF_JOB, examples=["customer-4711"])
    webhook: WebhookTarget | None = Field(
        default=None, description="Where to tell of the job's end."
    )

    @model_validator(mode="after")
    def _some_term_counts(self) -> Self:
        if self.paper is None or self.cues is Cues.SES:
            return self
        if set(self.paper.energies) == {PaperEnergy.SHADING}:
            raise refusal(
                code="wrong-length",
                reason="No term counts: shading counts with the cues 'SES' alone.",
                field="paper.energies",
                remedy="Send 'SES' in 'cues', or another term in 'paper.energies'.",
            )
        return self

    @property
    def pictures(self) -> tuple[Self]:
        """What is asked of its only picture."""
        return (self,)

    def understood(self, points: Sequence[Mapping[PointName, Point]]) -> FitOptions:
        """The fit alone, without what concerns only the submission.

        Parameters
        ----------
        points
            Those of its only picture, by their names.
        """
        (of_picture,) = points
        values: dict[str, Any] = {name: getattr(self, name) for name in FitChoices.model_fields}
        return FitOptions.model_construct(**values | self.named(of_picture))


class FitOfImage(FitRequest):
    """A submission whose picture was uploaded before."""

    image_id: ImageId
    mask_id: ImageId | None = Field(
        default=None,
        description="A grey picture of the same size; the person is brighter than half.",
    )
