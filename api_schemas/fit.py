"""A caller's request: a fit of one person to one to six pictures."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Final, Self

from pydantic import AfterValidator, Field, model_validator

from api_schemas.base import WireModel, refusal
from api_schemas.jobs import WebhookTarget
from api_schemas.labels import LABEL_OF_FIT, Label
from api_schemas.person import Person
from api_schemas.picture import ViewRequest
from api_schemas.points import AUTO, Point
from fitter.vocabulary.choices import Cues, OptimizerKind, PaperEnergy, ViewKind
from fitter.vocabulary.points import PointName

MOST_VIEWS: Final = 6

SEEN_ONCE: Final = (ViewKind.FRONT, ViewKind.BACK)
"""Views of which a fit has one at most: people have two sides, but one front."""


class PaperMethod(WireModel):
    """The paper's own method: its energies alone, in the tri-map of the first body."""

    energies: tuple[PaperEnergy, ...] = Field(
        default=tuple(PaperEnergy),
        min_length=1,
        max_length=len(PaperEnergy),
        description="The terms that count.",
    )
    free_height: bool = Field(default=False, description="Find the height too.")


def _usable_together(views: tuple[ViewRequest, ...]) -> tuple[ViewRequest, ...]:
    if len(views) == 1:
        return views
    for number, each in enumerate(views):
        if each.view is None:
            raise refusal(
                code="missing",
                field=f"views.{number}.view",
                reason="Of several pictures each has to say from where it shows the person.",
                remedy=f"Send one of {', '.join(ViewKind)}.",
            )
        if each.view in SEEN_ONCE and any(each.view is other.view for other in views[:number]):
            raise refusal(
                code="repeated-view",
                field=f"views.{number}.view",
                reason=f"Two pictures are said to show the {each.view}.",
                remedy="Send one of them, or say what the other shows: "
                f"{', '.join(kind for kind in ViewKind if kind is not each.view)}.",
            )
    return views


class FitRequest(Person):
    """A fit: who is in the pictures, what to do, and each of the pictures.

    The body has the height, the weight and the measurements that are given. ``height_m`` left out
    means the mean of the gender, or the most probable height of people with the given measurements;
    the answer then lists it as assumed.
    """

    views: Annotated[tuple[ViewRequest, ...], AfterValidator(_usable_together)] = Field(
        default=(ViewRequest(),),
        min_length=1,
        max_length=MOST_VIEWS,
        description=(
            "The pictures in their order; of several, `front` and `side` to begin with. At most "
            "one each is `front` or `back`; sizes, lenses and orientations may differ. Faults of a "
            "picture have fields that begin with its place, `views.1.points`."
        ),
    )
    cues: Cues = Field(
        default=Cues.SES, description="`SE`: silhouette and edges; `SES`: shading too."
    )
    optimizer: OptimizerKind = Field(
        default=OptimizerKind.GAUSS_NEWTON,
        description="`simplex` is the paper's, and takes minutes.",
    )
    force: bool = Field(
        default=False,
        description=(
            "Give measurements even if the verdict is `implausible` or `no_person`, and those that "
            "are hardly known; otherwise they are withheld."
        ),
    )
    paper: PaperMethod | None = Field(
        default=None,
        description=(
            "Fit one picture as the paper does; the result's `differences` say what is not as "
            "there."
        ),
    )
    label: Label | None = Field(default=None, description=LABEL_OF_FIT, examples=["customer-4711"])
    webhook: WebhookTarget | None = Field(
        default=None, description="Where to tell of the fit's end."
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

    def understood(self, points: Sequence[Mapping[PointName, Point]]) -> Self:
        """The request with named points, and without whom to tell: an address may hold secrets.

        Parameters
        ----------
        points
            The given ones of every picture, by their names.
        """
        views = tuple(
            view if view.points == AUTO else view.model_copy(update={"points": dict(named)})
            for view, named in zip(self.views, points, strict=True)
        )
        return self.model_copy(update={"views": views, "webhook": None})
