"""People in clothes, fitted with each thing that may be said of them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from fitter.vocabulary.choices import Clothing, Cues
from tests.accuracy.runs import of_each, picture_of
from tests.accuracy.scoring import Scored, fit_picture, score
from tests.accuracy.seen_labels import label_overlaps, seen_parts
from tests.accuracy.true_picture import Told, TruePicture

NOTHING_SAID = Clothing.AUTO.value

SAID: Mapping[str, Told] = {
    **{said.value: Told(clothing=said) for said in Clothing if said is not Clothing.OUTER},
    "auto, weight": Told(measurements=("weight",)),
}
"""Rows of the tables."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class DressedScore:
    """One fit of a person in clothes.

    ``said`` is a row of :data:`SAID`, ``outfit`` the class of what is worn, and ``overlaps`` those
    of :func:`~tests.accuracy.seen_labels.label_overlaps`, empty where labels are not known or
    something was said of clothes.
    """

    said: str
    outfit: str
    scored: Scored
    overlaps: Mapping[str, float | None]


def score_dressed(names: Sequence[str], *, jobs: int) -> Iterator[list[DressedScore]]:
    """Each picture by SES: nothing said, clothes said to be tight and loose, the weight given."""
    return of_each(_score_dressed, names, jobs)


def score_undressed(names: Sequence[str], *, jobs: int) -> list[Scored]:
    """The same for people in underwear, of whom nothing is said."""
    return list(of_each(_score_undressed, names, jobs))


def _score_dressed(name: str) -> list[DressedScore]:
    picture = picture_of(name)
    return [_score(picture, said, told) for said, told in SAID.items()]


def _score(picture: TruePicture, said: str, told: Told) -> DressedScore:
    fitted = fit_picture(picture, Cues.SES, told)
    overlaps: Mapping[str, float | None] = {}
    if said == NOTHING_SAID and picture.labels is not None:
        overlaps = label_overlaps(seen_parts(picture.request.views[0].image), picture.labels)
    return DressedScore(said=said, outfit=picture.outfit, scored=score(fitted), overlaps=overlaps)


def _score_undressed(name: str) -> Scored:
    return score(fit_picture(picture_of(name), Cues.SES, Told()))
