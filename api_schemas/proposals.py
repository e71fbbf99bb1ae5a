"""Points that a detector proposes: to be looked at, corrected and sent with a fit."""

from typing import Literal

from pydantic import Field

from api_schemas.base import Place, WireModel
from api_schemas.images import ImageId
from api_schemas.points import PointSource
from api_schemas.results import FitWarning
from fitter.vocabulary.points import PointName


class PointsRequest(WireModel):
    """Of whom points are wanted, and what else."""

    person: Place | None = Field(
        default=None,
        description="Place among the persons found; the largest and surest if left out.",
    )
    mask: bool = Field(default=False, description="Whether the person's mask is wanted too.")


class PointsOfImage(PointsRequest):
    """The same of a picture that was uploaded before."""

    image_id: ImageId


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


class PointsProposal(WireModel):
    """Who is in the picture, and where one of them has which point.

    Pixels of the picture as a browser shows it, of ``image_size``. ``persons`` has the largest and
    surest first; ``points`` are those of the ``person`` at that place, null where there is nobody.
    ``points`` can be sent as those of a fit or an initial pose. ``doubtful`` names those that are
    to be looked at one by one.

    Warnings: ``nobody-found``, ``several-people``, ``cut-off``, ``person-too-small``,
    ``seen-from-behind``, ``limbs-crossed``, and what a fit says of a picture.
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
    warnings: tuple[FitWarning, ...]
