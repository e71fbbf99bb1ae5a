"""What a fault of the two photographs costs: scans of people as phones take them, spoilt.

Points are proposed by the detector, as for whoever takes pictures to be measured, and both pictures
have the same fault. Faults of the picture spoil the suite's phone pairs; faults of stance and
camera are rendered plainly, without hair, before an even wall, and are to be compared with the same
people rendered so without a fault.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import cv2
import numpy as np

from fitter.errors import FitterError
from fitter.fits.capture_check import CaptureQuestion
from fitter.fits.pipeline import fit
from fitter.observation.decoding import decode_picture
from fitter.request import FitRequest, KnownMeasurement
from fitter.vocabulary.choices import ViewKind
from tests.evaluation.capture_forms import (
    ROLLED_SCALE,
    Picture,
    Source,
    Spoil,
    blurred,
    cropped,
    exposed,
    far_away,
    rolled,
)
from tests.evaluation.people import load_person
from tests.evaluation.people_table import PEOPLE, SITTERS
from tests.evaluation.phone_cases import PHONE_PAIRS, PhonePair
from tests.evaluation.plain_rendering import plain_picture
from tests.evaluation.runs import picture_of
from tests.evaluation.scene import Arm, Case, Half
from tests.evaluation.staging import camera_of
from tests.evaluation.table import MEASUREMENTS
from tests.evaluation.true_picture import TruePicture
from tests.evaluation.truth import true_body
from tests.one_picture import changed, together

MAX_PIXELS = 50_000_000
QUALITY = 92
SMALL_STATURE_PX = 200.0

Change = Callable[[FitRequest, Mapping[str, float]], FitRequest]
"""What is typed in otherwise, of a request and the true measurements."""

Restage = Callable[[Case], Case]


class Kind(StrEnum):
    """How the pictures of a fault are made, with the figures to compare it with."""

    PHONE = "phone pairs"
    PLAIN = "plainly rendered"


@dataclass(frozen=True, slots=True, kw_only=True)
class Cost:
    """A person measured in spite of a fault; no ``errors`` where the scan was refused.

    ``errors`` are measured minus true, by measurement.
    """

    kind: Kind
    fault: str
    person: str
    errors: Mapping[str, float] | None


def costs_of(person: str) -> list[Cost]:
    """Every fault of both kinds, of one of the phone pairs' people."""
    pair = next(pair for pair in PHONE_PAIRS.values() if pair.person == person)
    pictures = {
        kind: picture_of(case.name)
        for kind, case in ((ViewKind.FRONT, pair.front), (ViewKind.SIDE, pair.side))
    }
    found = [
        _cost(Kind.PHONE, name, person, [_spoilt(kind, it, spoil) for kind, it in pictures.items()])
        for name, spoil in SPOILT.items()
    ]
    plain = [_spoilt(kind, it, _as_it_is) for kind, it in pictures.items()]
    truth = _truth(person)
    found += [
        _cost(
            Kind.PHONE,
            name,
            person,
            [typed(each, truth) for each in plain],
        )
        for name, typed in TYPED.items()
    ]
    return found + [
        _cost(Kind.PLAIN, name, person, _rendered(pair, restaged, pictures))
        for name, restaged in RESTAGED.items()
    ]


def people_of(half: Half) -> list[str]:
    """Of the phone pairs."""
    return [pair.person for pair in PHONE_PAIRS.values() if PEOPLE[pair.person].half is half]


def cost_lines(costs: Sequence[Cost]) -> list[str]:
    """Mean absolute errors, in brackets their mean, by fault; then how many scans were refused."""
    columns = "".join(f"{f'{name} {unit}':>15s}" for name, _, unit in MEASUREMENTS)
    lines: list[str] = []
    for kind in Kind:
        lines += ["", f"{kind.value:34s}{columns}{'refused':>9s}"]
        of_kind = [each for each in costs if each.kind is kind]
        for fault in dict.fromkeys(each.fault for each in of_kind):
            these = [each for each in of_kind if each.fault == fault]
            line = f"{fault:34s}"
            for _, key, _ in MEASUREMENTS:
                errors = np.array([each.errors[key] for each in these if each.errors])
                said = f"{np.abs(errors).mean():.2f} ({errors.mean():+.2f})" if len(errors) else "-"
                line += f"{said:>15s}"
            lines.append(line + f"{sum(each.errors is None for each in these):9d}")
    return lines


def _as_it_is(source: Source) -> Picture:
    return source.picture


def _small(source: Source) -> Picture:
    return far_away(source, stature_px=SMALL_STATURE_PX)


def _rolled(source: Source) -> Picture:
    return rolled(source, degrees=10.0)


SPOILT: Mapping[str, Spoil] = {
    "as they are": _as_it_is,
    "blurred by 2 px": lambda it: blurred(it, deviation_px=2.0),
    "blurred by 4 px": lambda it: blurred(it, deviation_px=4.0),
    "a fortieth of the light": lambda it: exposed(it, factor=0.025),
    "three times the light": lambda it: exposed(it, factor=3.0),
    "rolled by 10 degrees": _rolled,
    "without the feet": lambda it: cropped(it, bottom=0.93),
    "200 px far away": _small,
}
"""How both pictures are spoilt."""

TYPED: Mapping[str, Change] = {
    "weight given": lambda request, truth: _with_weight(request, truth["weight"]),
    "weight given 3 kg too high": lambda request, truth: _with_weight(
        request, truth["weight"] + 3.0
    ),
    "height 3 cm too high": lambda request, truth: changed(
        request, height_m=round((request.person.height_m or 0.0) + 0.03, 3)
    ),
    "lens not known": lambda request, truth: changed(request, focal_length_px=None),
}
"""What is typed in otherwise, of the pictures as they are."""

RESTAGED: Mapping[str, Restage] = {
    "2.2 m, camera at 1.1 m": lambda case: case,
    "1.3 m, wide lens": lambda case: _seen(case, distance_m=1.3, equivalent_mm=16),
    "3.3 m": lambda case: _seen(case, distance_m=3.3),
    "camera at 0.5 m": lambda case: _seen(case, height_m=0.5),
    "camera at 1.7 m": lambda case: _seen(case, height_m=1.7),
    "front: arms hanging": lambda case: _hanging(case),
    "front: turned by 15 degrees": lambda case: _turned(case, ViewKind.FRONT, 15.0),
    "side: turned by 15 degrees": lambda case: _turned(case, ViewKind.SIDE, 15.0),
    "side: arms hanging": lambda case: _side_arms(case, Arm(raised=18.0, forward=25.0, bend=10.0)),
    "side: arms stretched": lambda case: _side_arms(case, Arm(raised=83.0, forward=88.0, bend=8.0)),
    "side: arms before the belly": lambda case: _side_arms(
        case, Arm(raised=24.0, forward=60.0, bend=80.0)
    ),
}
"""How people stand and from where they are seen."""


def _cost(kind: Kind, fault: str, person: str, requests: Sequence[FitRequest]) -> Cost:
    try:
        measured = {each.name: each.value for each in fit(together(*requests)).measurements}
    except FitterError:
        return Cost(kind=kind, fault=fault, person=person, errors=None)
    truth = _truth(person)
    errors = {key: measured[key] - truth[key] for _, key, _ in MEASUREMENTS}
    return Cost(kind=kind, fault=fault, person=person, errors=errors)


def _spoilt(kind: ViewKind, picture: TruePicture, spoil: Spoil) -> FitRequest:
    pixels = decode_picture(
        picture.request.views[0].image, field="image", max_pixels=MAX_PIXELS
    ).pixels
    source = Source(picture=pixels, mask=picture.person_mask, question=CaptureQuestion())
    spoilt = spoil(source)
    return _view(kind, picture, spoilt, picture.focal_length_px * _zoom(source, spoil))


def _zoom(source: Source, spoil: Spoil) -> float:
    """How much smaller the spoilt picture shows the person, and so its focal length is."""
    if spoil is _rolled:
        return ROLLED_SCALE
    if spoil is _small:
        rows = np.flatnonzero(source.mask.any(axis=1))
        return SMALL_STATURE_PX / float(rows[-1] - rows[0] + 1)
    return 1.0


def _rendered(
    pair: PhonePair, restaged: Restage, pictures: Mapping[ViewKind, TruePicture]
) -> list[FitRequest]:
    requests: list[FitRequest] = []
    for kind, case in ((ViewKind.FRONT, pair.front), (ViewKind.SIDE, pair.side)):
        placed = restaged(_seen(case, distance_m=2.2, height_m=1.1))
        shown = plain_picture(placed, turned_deg=0.0)
        requests.append(_view(kind, pictures[kind], shown, camera_of(placed.view).focal_length_px))
    return requests


def _view(
    kind: ViewKind, picture: TruePicture, shown: Picture, focal_length_px: float
) -> FitRequest:
    made, coded = cv2.imencode(
        ".jpg", np.ascontiguousarray(shown[:, :, ::-1]), (cv2.IMWRITE_JPEG_QUALITY, QUALITY)
    )
    if not made:
        message = "OpenCV could not encode a picture."
        raise RuntimeError(message)
    return changed(
        picture.request,
        kind=kind,
        image=coded.tobytes(),
        clicks={},
        complete_clicks=True,
        focal_length_px=focal_length_px,
    )


def _truth(person: str) -> Mapping[str, float]:
    return true_body(load_person(PEOPLE[person])).measurements


def _with_weight(request: FitRequest, weight_kg: float) -> FitRequest:
    return changed(request, measurements={"weight": KnownMeasurement(value=weight_kg)})


def _seen(
    case: Case,
    *,
    distance_m: float | None = None,
    height_m: float | None = None,
    equivalent_mm: int | None = None,
) -> Case:
    view = case.view
    return replace(
        case,
        view=replace(
            view,
            distance_m=distance_m or view.distance_m,
            height_m=height_m or view.height_m,
            equivalent_mm=equivalent_mm or view.equivalent_mm,
        ),
    )


def _hanging(case: Case) -> Case:
    """Arms beside the trunk, as near as the person's breadth lets them hang."""
    if not _is_front(case):
        return case
    (sitter,) = (each for each in SITTERS if each.source.name == case.person)
    return _with_arms(case, Arm(raised=8.0 + sitter.arms))


def _side_arms(case: Case, arm: Arm) -> Case:
    return case if _is_front(case) else _with_arms(case, arm)


def _with_arms(case: Case, arm: Arm) -> Case:
    return replace(case, stance=replace(case.stance, left_arm=arm, right_arm=arm))


def _turned(case: Case, kind: ViewKind, degrees: float) -> Case:
    if _is_front(case) is not (kind is ViewKind.FRONT):
        return case
    # Toward the camera in profile, so that it is seen half from the front.
    sign = -np.sign(case.stance.facing) if kind is ViewKind.SIDE else 1.0
    facing = case.stance.facing + float(sign) * degrees
    return replace(case, stance=replace(case.stance, facing=facing))


def _is_front(case: Case) -> bool:
    return case.name.endswith("_front")
