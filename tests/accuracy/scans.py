"""People measured from the front, from the side and from both, with their weight and without."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from fitter.body.model import regress
from fitter.fits.pipeline import fit
from fitter.render.rasterizer import render
from fitter.result import FitResult
from fitter.vocabulary.choices import Clothing, Cues, ViewKind
from tests.accuracy.cases import CLOTHED_PAIRS, PHONE_PAIRS, PicturePair
from tests.accuracy.foreign import foreign_names
from tests.accuracy.people import packaged_model
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Half, Kind, Series
from tests.accuracy.scoring import errors_of, overlap, standard_errors_of
from tests.accuracy.table import MEASUREMENTS, error_heading, error_line
from tests.accuracy.true_picture import Told, TruePicture, told_request
from tests.accuracy.truth import joint_error_mm
from tests.one_picture import changed, together

OTHER_KINDS = (Kind.STANDING, Kind.TURNED)
"""The suite's pictures of a person that make a pair four."""

WORST = 8


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
    front: str
    side: str
    others: tuple[str, ...] = ()
    dressed: bool = False

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
    """The figures of one person by some views and what was said beside, which ``row`` names.

    ``joint_mm`` and ``overlap``, with the true body's mask, are means over the pictures.
    """

    row: str
    person: str
    errors: Mapping[str, float]
    standard_errors: Mapping[str, float]
    joint_mm: float
    overlap: float


def pairs_of(series: Series, half: Half) -> list[Pair]:
    """The pairs of a set of pictures: phones' with two other pictures, in clothes, foreign."""
    if series is Series.FOREIGN:
        names = foreign_names(half)
        people = [name[:-1] for name in names if name.endswith("f") and f"{name[:-1]}s" in names]
        return [Pair(person=each, front=f"{each}f", side=f"{each}s") for each in people]
    dressed = series is Series.CLOTHED_PAIRS
    pairs = (CLOTHED_PAIRS if dressed else PHONE_PAIRS).values()
    return [_own(each, dressed=dressed) for each in pairs if PEOPLE[each.person].half is half]


def _own(pair: PicturePair, *, dressed: bool) -> Pair:
    others = () if dressed else tuple(f"{pair.person}_{kind.value}" for kind in OTHER_KINDS)
    return Pair(
        person=pair.person,
        front=pair.front.name,
        side=pair.side.name,
        others=others,
        dressed=dressed,
    )


def scanned(pair: Pair, *, proposed: bool = False) -> list[Scanned]:
    """A pair by all views, without the weight and with it; clothes also said to be tight, loose.

    By clicks, or by points that the detector proposes.
    """
    pictures = {name: picture_of(name) for name in pair.kinds}
    told = {"": Told(proposed=proposed)}
    told[", weight"] = Told(proposed=proposed, measurements=("weight",))
    if pair.dressed:
        for said in (Clothing.LOOSE, Clothing.TIGHT):
            told[f", said {said}"] = Told(proposed=proposed, clothing=said)
    return [
        each for said, what in told.items() for each in _by_all_views(pair, pictures, said, what)
    ]


def _by_all_views(
    pair: Pair, pictures: Mapping[str, TruePicture], said: str, told: Told
) -> Iterator[Scanned]:
    requests = {
        name: changed(told_request(pictures[name], told), kind=kind, cues=Cues.SES)
        for name, kind in pair.kinds.items()
    }
    for views, names in pair.pictures_by_views.items():
        found = fit(together(*(requests[name] for name in names)))
        yield _scanned(f"{views}{said}", pair.person, [pictures[name] for name in names], found)


def _scanned(row: str, person: str, pictures: Sequence[TruePicture], found: FitResult) -> Scanned:
    model = packaged_model(pictures[0].request.person.gender)
    joints, overlaps = [], []
    for picture, seen in zip(pictures, found.views, strict=True):
        posed = seen.found.posed_vertices
        shown = render(posed, model.triangles, seen.found.person.camera).silhouette
        joints.append(joint_error_mm(regress(model.joint_regressor, posed), picture.joints))
        overlaps.append(overlap(shown, picture.body_mask))
    return Scanned(
        row=row,
        person=person,
        errors=errors_of(found, pictures[0].truth),
        standard_errors=standard_errors_of(found),
        joint_mm=float(np.mean(joints)),
        overlap=float(np.mean(overlaps)),
    )


def scan_lines(found: Sequence[Scanned]) -> list[str]:
    """Errors by views and what was said; the joints' distance and the overlap; then the worst."""
    lines = [f"{error_heading('views')}{'joints mm':>11s}{'overlap':>9s}"]
    for row in dict.fromkeys(each.row for each in found):
        these = [each for each in found if each.row == row]
        joints, overlaps = (
            np.mean([getattr(each, name) for each in these]) for name in ("joint_mm", "overlap")
        )
        lines.append(f"{error_line(row, these, places=2)}{joints:11.1f}{overlaps:9.3f}")
    both = [each for each in found if each.row == Views.BOTH]
    worst = [
        f"{each.person:32s}"
        + "".join(f"{each.errors[key]:+11.1f}" for _, key, _ in MEASUREMENTS)
        + f"{each.joint_mm:11.1f}{each.overlap:9.3f}"
        for each in sorted(both, key=_mean_girth_error, reverse=True)[:WORST]
    ]
    return [*lines, "", f"worst, {Views.BOTH}", *worst]


def _mean_girth_error(each: Scanned) -> float:
    return float(np.mean([abs(each.errors[key]) for _, key, unit in MEASUREMENTS if unit == "cm"]))
