"""Questions that are answered at once: bodies, initial poses, points; without a job."""

from typing import Final

from pydantic import Field

from api_schemas.base import Place, WholeNumber, WireModel
from api_schemas.person import HeightM, Person
from api_schemas.picture import (
    POINTS_DESCRIPTION,
    POINTS_EXAMPLE,
    ImageId,
    Lens,
    Limb,
    LimbFacings,
)
from api_schemas.points import NamedPoint, Point, Points
from api_schemas.results import (
    BodyResult,
    CameraResult,
    Measurement,
)
from fitter.vocabulary.choices import Facing, Gender, ViewKind
from fitter.vocabulary.outcomes import ClothingGuess, FocalLengthSource, LimbFacing, SeenFrom
from fitter.vocabulary.points import PointName
from fitter.vocabulary.remarks import Box, Remark


class BodyRequest(Person):
    """Known facts about the person."""


class BodyEstimate(WireModel):
    """The most probable body of a person with the known measurements.

    ``shape`` are coefficients in standard deviations, the first of them the height.
    ``plausibility`` is the share of the population whose measurements of the given names are
    together at least as unusual. Of people of whom the same is known 95 % lie between ``low`` and
    ``high`` of a measurement; what the body model itself gets wrong is not in them. Warnings:
    ``unusual-height`` where bodies of the height are extrapolated, with wider errors.
    """

    gender: Gender
    height_m: float
    shape: tuple[float, ...]
    measurements: tuple[Measurement, ...]
    plausibility: float = Field(ge=0.0, le=1.0)
    body_model: str = Field(description="Checksum of the body model.")
    warnings: tuple[Remark, ...] = ()


MAX_SIDE: Final = 100_000


class ImageSize(WireModel):
    """Size of the picture as a browser shows it, pixels."""

    width: WholeNumber = Field(ge=1, le=MAX_SIDE, examples=[720])
    height: WholeNumber = Field(ge=1, le=MAX_SIDE, examples=[960])


class InitialPoseRequest(Person, Lens):
    """The person in the picture, the places of the joints, and the size of the picture."""

    points: Points = Field(description=f"{POINTS_DESCRIPTION}.", examples=[POINTS_EXAMPLE])
    limb_facing: LimbFacings = Field(default_factory=dict[Limb, Facing])
    image_size: ImageSize


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
    limbs: tuple[LimbFacing, ...]
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]


class PointsRequest(Lens):
    """Known facts about a picture, and what is wanted of it; all of it may be left out."""

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
    gender: Gender | None = Field(
        default=None, description="Says what height is assumed if none is given."
    )
    height_m: HeightM | None = None
    mask: bool = Field(default=False, description="Whether the person's mask is wanted too.")


class PointsProposal(WireModel):
    """The people in the picture, the points of one of them, and what is wrong with the picture.

    Pixels of the picture as a browser shows it, of ``image_size``. ``persons`` are the boxes of
    what is seen of them (left, top, right, bottom), the largest and surest first; ``points`` are
    those of the ``person`` at that place, null where there is nobody. ``points`` can be sent as
    those of a fit or an initial pose; their ``confidence`` is how sure the detector is that the
    point is seen. ``doubtful`` names those that are to be looked at one by one.

    ``findings`` are those of a fit of the picture, most important first, and it is ``usable`` if
    none ``blocks``; ``not_checked`` has those that nothing can be said of. ``lean_deg`` is how far
    the person leans to the right of the picture from ankles to shoulders, null unless they stand
    upright; ``distance_m`` how far the camera was, null unless the focal length is known;
    ``clothing`` how clothes look, in a word that the request of a fit may say: never ``auto``.

    Codes: ``nobody-found``, ``several-people``, ``cut-off``, ``person-too-small``,
    ``picture-too-small``, ``other-view``, ``arms-against-trunk``, ``clothes-loose``, ``blurred``,
    ``too-dark``, ``too-bright``, ``camera-rolled``, ``camera-too-near``, ``not-standing``,
    ``child``, ``skin-not-found``, ``face-hidden``; others may be added. Warnings are those of a
    fit, and ``seen-from-behind`` and ``limbs-crossed``.
    """

    image_size: ImageSize
    persons: tuple[Box, ...]
    person: int | None
    points: dict[PointName, Point]
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
    findings: tuple[Remark, ...]
    not_checked: tuple[Remark, ...]
    seen_from: SeenFrom | None
    lean_deg: float | None
    distance_m: float | None
    clothing: ClothingGuess | None
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]
