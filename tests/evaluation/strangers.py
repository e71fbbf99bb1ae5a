"""How often a scan tells that its pictures show different people, and how often in vain."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from fitter.fits.pipeline import fit
from fitter.person.several_pictures import SAME_PERSON_PROBABILITY
from fitter.vocabulary.choices import Cues, ViewKind
from tests.evaluation.people_table import PEOPLE
from tests.evaluation.runs import picture_of
from tests.evaluation.scans import Pair, foreign_pairs, own_pairs, repeated_pairs
from tests.evaluation.scene import Half
from tests.evaluation.true_picture import Told, told_request
from tests.one_picture import changed, together

TRUNK = ("chest_girth", "waist_girth_smallest", "hip_girth")

UNLIKE_CM = (0.0, 5.0, 10.0, 20.0)
"""Strangers are sorted by the largest of these differences that they exceed."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Pictures:
    """A picture from the front and one from another side, by name; all told the front's height."""

    front: str
    other: str
    kind: ViewKind
    same: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """How well two pictures agree, and by how much their people's trunks differ.

    ``unlike_cm`` is the largest difference of three girths, once the stranger is brought to the
    height that was told.
    """

    pictures: Pictures
    unlike_cm: float
    agreement: float


def asked_of(half: Half) -> list[Pictures]:
    """Everybody with themselves, and with everybody else of their gender, half and maker."""
    return [*_of_one(half), *_of_two(half)]


def _of_one(half: Half) -> Iterator[Pictures]:
    for pair in (*own_pairs(half), *repeated_pairs(half), *foreign_pairs(half)):
        for other, kind in pair.kinds.items():
            if other != pair.front:
                yield Pictures(front=pair.front, other=other, kind=kind, same=True)


def _of_two(half: Half) -> Iterator[Pictures]:
    for pairs in (own_pairs(half), foreign_pairs(half)):
        people = [(pair, _gender(pair)) for pair in pairs]
        for one, gender in people:
            for stranger, of_stranger in people:
                if one is not stranger and gender is of_stranger:
                    yield Pictures(
                        front=one.front, other=stranger.side, kind=ViewKind.SIDE, same=False
                    )


def _gender(pair: Pair) -> object:
    if pair.person in PEOPLE:
        return PEOPLE[pair.person].gender
    return picture_of(pair.front).request.person.gender


def agreement_of(pictures: Pictures) -> Agreement:
    """Scan the two."""
    front, other = picture_of(pictures.front), picture_of(pictures.other)
    height_m = front.request.person.height_m
    assert height_m is not None
    requests = [
        changed(told_request(picture, Told()), kind=kind, cues=Cues.SE, height_m=height_m)
        for picture, kind in ((front, ViewKind.FRONT), (other, pictures.kind))
    ]
    found = fit(together(*requests)).alone
    assert found is not None
    taller = front.truth.stature_m / other.truth.stature_m
    return Agreement(
        pictures=pictures,
        unlike_cm=max(
            abs(front.truth.measurements[name] - taller * other.truth.measurements[name])
            for name in TRUNK
        ),
        agreement=found.agreement,
    )


def stranger_lines(found: Sequence[Agreement]) -> list[str]:
    """How many are below some shares, of one person and of strangers by how unlike they are."""
    shares = (0.01, 0.05, SAME_PERSON_PROBABILITY, 0.2, 0.5)
    heading = "".join(f"{f'< {share:g}':>8s}" for share in shares)
    lines = [f"{'agreement':32s}{'pairs':>7s}{heading}{'least':>8s}"]
    groups = {"one person": [each for each in found if each.pictures.same]}
    for low, high in pairwise([*UNLIKE_CM, np.inf]):
        groups[f"strangers, {low:g} to {high:g} cm"] = [
            each for each in found if not each.pictures.same and low <= each.unlike_cm < high
        ]
    for title, group in groups.items():
        if group:
            agreements = np.array([each.agreement for each in group])
            counts = "".join(f"{int((agreements < share).sum()):8d}" for share in shares)
            lines.append(f"{title:32s}{len(group):7d}{counts}{agreements.min():8.3f}")
    return lines
