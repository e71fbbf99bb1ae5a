"""Questions that are answered at once: bodies, initial poses, points; without a job."""

from typing import Final, Literal, Self

from pydantic import Field, model_validator

from api_schemas.base import Place, WholeNumber, WireModel, refusal
from api_schemas.person import HeightM, Person
from api_schemas.picture import (
    POINTS_DESCRIPTION,
    POINTS_EXAMPLE,
    ImageId,
    LaidOut,
    Lens,
    Limb,
    LimbFacings,
)
from api_schemas.points import NamedPoint, Points, PointsFormat, PointSource
from api_schemas.results import Assumption, BodyResult, CameraResult, Finding, FitWarning
from fitter.vocabulary.choices import Facing, Gender, ViewKind
from fitter.vocabulary.outcomes import FocalLengthSource, SeenFrom
from fitter.vocabulary.points import PointName


class BodyRequest(Person):
    """Of whom what is known."""

    include_glb: bool = Field(
        default=False,
        description=(
            "Put the body's GLB file into the JSON answer. `Accept: model/gltf-binary` answers "
            "with the file itself instead."
        ),
    )


class EstimatedMeasurement(WireModel):
    """A measurement of the most probable body.

    Of people of whom the same is known ``standard_error`` is the standard deviation, and 95 % lie
    between ``low`` and ``high``; what the body model itself gets wrong is not in them.
    """

    name: str
    value: float
    unit: str
    standard_error: float
    low: float
    high: float
    given: bool = Field(description="Whether the request named it.")
    definition: str
    source: str


class BodyEstimate(WireModel):
    """The most probable body of a person with the known measurements.

    ``shape`` are coefficients in standard deviations, the first of them the height.
    ``plausibility`` is the share of the population whose measurements of the given names are
    together at least as unusual. Warnings: ``unusual-height`` where bodies of the height are
    extrapolated, with wider errors.
    """

    gender: Gender
    height_m: float
    shape: tuple[float, ...]
    measurements: tuple[EstimatedMeasurement, ...]
    plausibility: float = Field(ge=0.0, le=1.0)
    body_model: str = Field(description="Checksum of the body model.")
    warnings: tuple[FitWarning, ...] = ()
    glb: str | None = Field(
        default=None,
        description="The body as a glTF 2.0 binary file, canonical pose, base64; if asked for.",
        json_schema_extra={"contentEncoding": "base64", "contentMediaType": "model/gltf-binary"},
    )


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


class PointsRequest(Lens):
    """What is said of a picture, and what is wanted of it; nothing needs to be said."""

    image_id: ImageId | None = Field(
        default=None, description="The uploaded picture, where none comes with the request."
    )
    view: ViewKind | None = Field(
        default=None, description="From where the person is to be seen; not checked if left out."
    )
    person: Place | None = Field(
        default=None,
        description="Place among the persons found; the largest and surest if left out.",
    )
    points: Points = Field(
        default_factory=dict[PointName, NamedPoint],
        description=(
            "Points that are known, pixels of the picture as a browser shows it. They say who of "
            "several people is meant; where the service has no detector, what they tell is all "
            "that is checked of the person."
        ),
    )
    format: LaidOut = PointsFormat.NAMED
    gender: Gender | None = Field(
        default=None, description="Says what height is assumed if none is given."
    )
    height_m: HeightM | None = None
    mask: bool = Field(default=False, description="Whether the person's mask is wanted too.")


class PictureSize(WireModel):
    """Size of the picture as a browser shows it, pixels."""

    width: int
    height: int


class FoundPerson(WireModel):
    """A person in the picture: left, top, right and bottom of what is seen, and how surely."""

    box: tuple[float, float, float, float]
    score: float = Field(ge=0.0, le=1.0)


class ProposedPoint(WireModel):
    """A proposed point; it can be sent with a fit as it is.

    ``visibility`` is COCO's: 2 seen, 1 hidden and guessed. ``confidence`` is how sure the detector
    is that the point is seen. ``expected_error_px`` is the root mean square error in each
    direction, for a person of 1.75 m.
    """

    x: float
    y: float
    visibility: Literal[1, 2]
    source: Literal[PointSource.PROPOSAL]
    confidence: float = Field(ge=0.0, le=1.0)
    expected_error_px: float = Field(ge=0.0)


class NotChecked(WireModel):
    """A check that could not be made, and why."""

    code: str
    reason: str


class PointsProposal(WireModel):
    """Who is in the picture, where one of them has which point, and what is wrong with it.

    Pixels of the picture as a browser shows it, of ``image_size``. ``persons`` has the largest and
    surest first; ``points`` are those of the ``person`` at that place, null where there is nobody.
    ``points`` can be sent as those of a fit or an initial pose. ``doubtful`` names those that are
    to be looked at one by one.

    ``findings`` are those of a fit of the picture, most important first, and it is ``usable`` if
    none ``blocks``; ``not_checked`` has those that nothing can be said of. ``lean_deg`` is how far
    the person leans to the right of the picture from ankles to shoulders, null unless they stand
    upright; ``distance_m`` how far the camera was, null unless the focal length is known.

    Codes: ``nobody-found``, ``several-people``, ``cut-off``, ``person-too-small``,
    ``picture-too-small``, ``other-view``, ``arms-against-trunk``, ``clothes-loose``, ``blurred``,
    ``too-dark``, ``too-bright``, ``camera-rolled``, ``camera-too-near``, ``not-standing``,
    ``child``, ``skin-not-found``; others may be added. Warnings are those of a fit, and
    ``seen-from-behind`` and ``limbs-crossed``.
    """

    image_size: PictureSize
    persons: tuple[FoundPerson, ...]
    person: int | None
    points: dict[PointName, ProposedPoint]
    doubtful: tuple[PointName, ...]
    mask: str | None = Field(
        default=None,
        description=(
            "How probably each pixel is the person's: a grey PNG of the picture's size, base64, if "
            "asked for. It can be sent as the `mask` of a fit."
        ),
        json_schema_extra={"contentEncoding": "base64", "contentMediaType": "image/png"},
    )
    usable: bool
    findings: tuple[Finding, ...]
    not_checked: tuple[NotChecked, ...]
    seen_from: SeenFrom | None
    lean_deg: float | None
    distance_m: float | None
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]
