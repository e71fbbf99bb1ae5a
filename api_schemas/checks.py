"""Checks of a picture before it is fitted: what a guide for taking it tells at once."""

from typing import Final

from pydantic import Field

from api_schemas.base import Place, WireModel
from api_schemas.images import ImageId
from api_schemas.person import HeightM
from api_schemas.picture import Lens
from api_schemas.points import NamedPoint, Points, PointsFormat
from api_schemas.proposals import PictureSize
from api_schemas.results import Assumption, Box, Finding, FitWarning
from fitter.vocabulary.choices import Gender, ViewKind
from fitter.vocabulary.outcomes import SeenFrom
from fitter.vocabulary.points import PointName

_POINTS_DESCRIPTION: Final = (
    "Points that are known, pixels of the picture as a browser shows it. They say who of several "
    "people is meant; where the service has no detector, what they tell is all that is checked of "
    "the person."
)


class CheckRequest(Lens):
    """What is said of the picture; nothing needs to be."""

    view: ViewKind | None = Field(
        default=None, description="From where the person is to be seen; not checked if left out."
    )
    person: Place | None = Field(
        default=None,
        description="Place among the persons found; the largest and surest if left out.",
    )
    points: Points = Field(
        default_factory=dict[PointName, NamedPoint], description=_POINTS_DESCRIPTION
    )
    format: PointsFormat = PointsFormat.NAMED
    gender: Gender | None = Field(
        default=None, description="Says what height is assumed if none is given."
    )
    height_m: HeightM | None = None


class CheckOfImage(CheckRequest):
    """The same of a picture that was uploaded before."""

    image_id: ImageId


class NotChecked(WireModel):
    """A check that could not be made, and why."""

    code: str
    reason: str


class CaptureCheck(WireModel):
    """What is wrong with a picture, most important first; ``usable`` if nothing ``blocks``.

    Pixels of the picture as a browser shows it, of ``image_size``; ``box`` is the person's, null
    where nobody was found or looked for. ``lean_deg`` is how far the person leans to the right of
    the picture from ankles to shoulders, null unless they stand upright; ``distance_m`` how far
    the camera was, null unless the focal length is known.

    Codes: ``nobody-found``, ``several-people``, ``cut-off``, ``person-too-small``,
    ``picture-too-small``, ``other-view``, ``arms-against-trunk``, ``clothes-loose``, ``blurred``,
    ``too-dark``, ``too-bright``, ``camera-rolled``, ``camera-too-near``, ``not-standing``,
    ``child``, ``skin-not-found``; others may be added.
    ``not_checked`` has those that nothing can be said of. Warnings are those of a fit.
    """

    image_size: PictureSize
    usable: bool
    findings: tuple[Finding, ...]
    not_checked: tuple[NotChecked, ...]
    box: Box | None
    seen_from: SeenFrom | None
    lean_deg: float | None
    distance_m: float | None
    assumptions: tuple[Assumption, ...]
    warnings: tuple[FitWarning, ...]
