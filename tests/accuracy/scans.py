"""People measured from the front, from the side and from both, with their weight and without."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from fitter.body.model import regress
from fitter.fits.pipeline import fit
from fitter.render.rasterizer import render
from fitter.result import FitResult
from fitter.vocabulary.choices import Clothing, Cues, ViewKind
from tests.accuracy.cases import CLOTHED_PAIRS
from tests.accuracy.foreign import foreign_half, foreign_names
from tests.accuracy.joint_figures import joint_error_mm
from tests.accuracy.landmark_points import packaged_model
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.phone_cases import PHONE_PAIRS, PhonePair
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Half, Series
from tests.accuracy.scoring import overlap
from tests.accuracy.stance_kinds import Kind
from tests.accuracy.true_picture import Told, TruePicture, told_request
from tests.one_picture import changed, together

OTHER_KINDS = (Kind.STANDING, Kind.TURNED)
"""The suite's pictures of a person that make a pair four."""


class Views(StrEnum):
    """The pictures that are fitted together."""

    FRONT = "front"
    SIDE = "side"
    BOTH = "front + side"
    FOUR = "four"


@dataclass(frozen=True, slots=True, kw_only=True)
class Pair:
    """Pictures of one person by their names: from the front, from the side, and others if any."""

    person: str
    series: Series
    half: Half
    front: str
    side: str
    others: tuple[str, ...] = ()

    @property
    def kinds(self) -> Mapping[str, ViewKind]:
        """From where each picture shows the person."""
        others = dict.fromkeys(self.others, ViewKind.OTHER)
        return {self.front: ViewKind.FRONT, self.side: ViewKind.SIDE, **others}

    @property
    def pictures_by_views(self) -> Mapping[Views, tuple[str, ...]]:
        """What is fitted together."""
        of: dict[Views, tuple[str, ...]] = {
            Views.FRONT: (self.front,),
            Views.SIDE: (self.side,),
            Views.BOTH: (self.front, self.side),
        }
        return {**of, Views.FOUR: (self.front, self.side, *self.others)} if self.others else of


@dataclass(frozen=True, slots=True, kw_only=True)
class Scanned:
    """The figures of one person by some views, and by what was said of clothes.

    ``errors`` are measured minus true, by measurement, ``standard_errors`` what the fit says of
    them but for what was given; ``joint_mm`` and ``overlap``, with the true body's mask, are means
    over the pictures.
    """

    person: str
    series: Series
    half: Half
    views: Views
    weight_given: bool
    clothing: Clothing = Clothing.AUTO
    errors: Mapping[str, float]
    standard_errors: Mapping[str, float]
    joint_mm: float
    overlap: float


def own_pairs(half: Half | None) -> list[Pair]:
    """One pair of each of the suite's people, with two other pictures of them."""
    pairs = [
        replace(
            _pair(pair),
            others=tuple(f"{pair.person}_{kind.value}" for kind in OTHER_KINDS),
        )
        for pair in PHONE_PAIRS.values()
    ]
    return [pair for pair in pairs if half in (None, pair.half)]


def clothed_pairs(half: Half | None) -> list[Pair]:
    """The pairs of the people who are shown so in their clothes."""
    pairs = [_pair(pair) for pair in CLOTHED_PAIRS.values()]
    return [pair for pair in pairs if half in (None, pair.half)]


def foreign_pairs(half: Half | None) -> list[Pair]:
    """Foreign people who have a picture from the front and one from the side."""
    names = foreign_names(half)
    people = [name[:-1] for name in names if name.endswith("f") and f"{name[:-1]}s" in names]
    return [
        Pair(
            person=person,
            series=Series.FOREIGN,
            half=foreign_half(person),
            front=f"{person}f",
            side=f"{person}s",
        )
        for person in people
    ]


def scanned(pair: Pair, *, proposed: bool = False) -> list[Scanned]:
    """A pair by all views, without the weight and with it; clothes also said to be tight, loose.

    By clicks, or by points that the detector proposes.
    """
    pictures = {name: picture_of(name) for name in pair.kinds}
    all_told = [Told(proposed=proposed), Told(proposed=proposed, measurements=("weight",))]
    if pair.series is Series.CLOTHED_PAIRS:
        others = [said for said in Clothing if said is not Clothing.AUTO]
        all_told += [Told(proposed=proposed, clothing=said) for said in others]
    return [each for told in all_told for each in _by_all_views(pair, pictures, told)]


def _by_all_views(pair: Pair, pictures: Mapping[str, TruePicture], told: Told) -> Iterator[Scanned]:
    requests = {
        name: changed(told_request(pictures[name], told), kind=kind, cues=Cues.SES)
        for name, kind in pair.kinds.items()
    }
    for views, names in pair.pictures_by_views.items():
        found = fit(together(*(requests[name] for name in names)))
        yield _scanned(pair, views, told, [pictures[name] for name in names], found)


def _pair(pair: PhonePair) -> Pair:
    return Pair(
        person=pair.person,
        series=pair.side.series,
        half=PEOPLE[pair.person].half,
        front=pair.front.name,
        side=pair.side.name,
    )


def _scanned(
    pair: Pair, views: Views, told: Told, pictures: Sequence[TruePicture], found: FitResult
) -> Scanned:
    measured = {each.name: each for each in found.measurements}
    truth = pictures[0].truth.measurements
    model = packaged_model(pictures[0].request.person.gender)
    joints, overlaps = [], []
    for picture, seen in zip(pictures, found.views, strict=True):
        posed = seen.found.posed_vertices
        shown = render(posed, model.triangles, seen.found.person.camera).silhouette
        joints.append(joint_error_mm(regress(model.joint_regressor, posed), picture.joints))
        overlaps.append(overlap(shown, picture.body_mask))
    return Scanned(
        person=pair.person,
        series=pair.series,
        half=pair.half,
        views=views,
        weight_given="weight" in found.given,
        clothing=told.clothing,
        errors={name: measured[name].value - value for name, value in truth.items()},
        standard_errors={
            name: each.standard_error
            for name, each in measured.items()
            if each.standard_error is not None and name not in found.given
        },
        joint_mm=float(np.mean(joints)),
        overlap=float(np.mean(overlaps)),
    )
