"""What misplaced points do to measurements: the same pictures with their points moved."""

import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np
from jaxtyping import Float

from fitter.fits.pipeline import fit
from fitter.request import Click, FitRequest
from fitter.result import FitResult
from tests.evaluation.runs import picture_of
from tests.evaluation.table import MEASUREMENTS
from tests.evaluation.true_picture import TruePicture
from tests.one_picture import changed

MOVED_M = 0.02
"""How far every point is moved, metres on the body."""


class Move(StrEnum):
    """How points are moved in the picture."""

    NONE = "none"
    UP = "all up"
    DOWN = "all down"
    ASIDE = "all aside"
    APART = "left and right apart"
    TOGETHER = "left and right together"
    SCATTERED = "each its own way"


@dataclass(frozen=True, slots=True, kw_only=True)
class MovedFit:
    """A fit of a picture whose points were moved; errors are measured minus true."""

    picture: str
    move: Move
    errors: Mapping[str, float]


def moved_fits(name: str) -> list[MovedFit]:
    """A picture with its points moved in every way."""
    picture = picture_of(name)
    still = fit(picture.request)
    pixels = MOVED_M * still.person.camera.focal_length_px / still.person.body.translation[2]
    found = {
        move: still if move is Move.NONE else fit(moved(picture.request, move, float(pixels)))
        for move in Move
    }
    return [
        MovedFit(picture=name, move=move, errors=_errors(picture, each))
        for move, each in found.items()
    ]


def moved(request: FitRequest, move: Move, pixels: float) -> FitRequest:
    """The request with every point so many pixels away from where it was."""
    middle = float(np.mean([click.x for click in request.views[0].clicks.values()]))
    clicks = {
        name: _shifted(click, pixels * _direction(name, click, move, middle))
        for name, click in request.views[0].clicks.items()
    }
    return changed(request, clicks=clicks)


def moved_lines(fits: Sequence[MovedFit]) -> list[str]:
    """Mean absolute change by the move, in brackets the mean; then mean absolute errors."""
    columns = "".join(f"{f'{name} {unit}':>16s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{'points moved by 2 cm: change':32s}{columns}"]
    still = {each.picture: each.errors for each in fits if each.move is Move.NONE}
    of = {move: [each for each in fits if each.move is move] for move in Move}
    for move, these in of.items():
        if move is not Move.NONE:
            line = f"{move.value:32s}"
            for _, key, _ in MEASUREMENTS:
                change = np.array([each.errors[key] - still[each.picture][key] for each in these])
                line += f"{f'{np.abs(change).mean():.2f} ({change.mean():+.2f})':>16s}"
            lines.append(line)
    lines.append("errors")
    for move, these in of.items():
        errors = [np.mean([abs(each.errors[key]) for each in these]) for _, key, _ in MEASUREMENTS]
        lines.append(f"{move.value:32s}" + "".join(f"{error:16.2f}" for error in errors))
    return lines


def _direction(name: str, click: Click, move: Move, middle: float) -> Float[np.ndarray, "2"]:
    """Unit vector of a point's move, or none for a middle point that has no side to go to."""
    outward = float(np.sign(click.x - middle)) if name.startswith(("left_", "right_")) else 0.0
    match move:
        case Move.NONE:
            return np.zeros(2)
        case Move.UP:
            return np.array([0.0, -1.0])
        case Move.DOWN:
            return np.array([0.0, 1.0])
        case Move.ASIDE:
            return np.array([1.0, 0.0])
        case Move.APART:
            return np.array([outward, 0.0])
        case Move.TOGETHER:
            return np.array([-outward, 0.0])
        case Move.SCATTERED:
            angle = zlib.crc32(f"{name} {click.x}".encode()) % 360
            return np.array([np.cos(np.radians(angle)), np.sin(np.radians(angle))])


def _shifted(click: Click, by: Float[np.ndarray, "2"]) -> Click:
    return replace(click, x=click.x + float(by[0]), y=click.y + float(by[1]))


def _errors(picture: TruePicture, result: FitResult) -> dict[str, float]:
    found = {each.name: each.value for each in result.measurements}
    return {key: found[key] - picture.truth.measurements[key] for _, key, _ in MEASUREMENTS}
