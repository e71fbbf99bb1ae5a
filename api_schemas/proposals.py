"""Points that a detector proposes, and what is wrong with the picture: before it is fitted."""

from typing import Literal

from pydantic import Field

from api_schemas.base import Place, WireModel
from api_schemas.images import ImageId
from api_schemas.person import HeightM
from api_schemas.picture import LaidOut, Lens
from api_schemas.points import NamedPoint, Points, PointsFormat, PointSource
from api_schemas.results import Assumption, Finding, FitWarning
from fitter.vocabulary.choices import Gender, ViewKind
from fitter.vocabulary.outcomes import SeenFrom
from fitter.vocabulary.points import PointName


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
