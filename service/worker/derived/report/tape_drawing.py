"""Where the chief measurements are taken: the body from three sides with numbered tapes."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from fitter.arrays import Points2D, Points3D
from fitter.export.tape_views import TapeView, best_sides, tape_views
from fitter.fits.prepared_model import prepared_model
from fitter.measurement.definitions import Extent, Height, Length
from fitter.person.fitted_person import FittedPerson
from fitter.vocabulary.measurements import CHIEF, STATURE, Group, group_of
from service.jobs.inputs import PERSON, TAPES

TAG_PX: Final = 21.0
"""Radius of a number's disc."""

_CANDIDATES: Final = 24
"""So many places along a tape are tried for its number."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Tag:
    """A number on its tape; the place in pixels of the picture."""

    number: int
    x: float
    y: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TapePanel:
    """The body from one side.

    ``lines`` are of the tapes whose numbers stand in ``tags``; ``others`` go round the body and
    have their number on another side. All are polylines in pixels of the picture.
    """

    view: TapeView
    lines: tuple[Points2D, ...]
    others: tuple[Points2D, ...]
    tags: tuple[Tag, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TapeDrawing:
    """The panels, and the number of each tape by the measurement's name."""

    panels: tuple[TapePanel, ...]
    numbers: Mapping[str, int]


def tape_drawing(inputs: Mapping[str, bytes], *, models: Path | None) -> TapeDrawing | None:
    """Draw the tapes that the fit laid; None where it has none, as of withheld measurements.

    Parameters
    ----------
    inputs
        The derivation's inputs by name.
    models
        Folder with the body models, None for those shipped with the package.
    """
    if TAPES not in inputs:
        return None
    lines = _lines(inputs[TAPES])
    person = FittedPerson.from_bytes(inputs[PERSON])
    measuring = prepared_model(person.gender, models=models).measuring
    vertices = measuring.canonical.at(person.body.shape)
    straight = {
        each.about.name
        for each in measuring.definitions
        if isinstance(each, Length | Height | Extent)
    }
    feet_on_floor = vertices - [0.0, vertices[:, 1].min(), 0.0]
    views = tape_views(feet_on_floor, measuring.triangles, lines, straight=straight)
    numbers = {name: number for number, name in enumerate(lines, start=1)}
    sides = best_sides(views)
    return TapeDrawing(
        panels=tuple(
            _panel(view, {name: numbers[name] for name in lines if sides[name] == view.side})
            for view in views
        ),
        numbers=numbers,
    )


def _lines(content: bytes) -> dict[str, Points3D]:
    """Tapes of the chief measurements in the result's order; the height needs none."""
    return {
        name: np.array(line, dtype=np.float64)
        for name, line in json.loads(content)["lines"].items()
        if name in CHIEF and name != STATURE
    }


def _panel(view: TapeView, numbers: Mapping[str, int]) -> TapePanel:
    return TapePanel(
        view=view,
        lines=tuple(line for name in numbers for line in view.lines[name]),
        others=tuple(
            line
            for name, lines in view.lines.items()
            if name not in numbers and group_of(name) is Group.GIRTHS
            for line in lines
        ),
        tags=_tags(view, numbers),
    )


def _tags(view: TapeView, numbers: Mapping[str, int]) -> tuple[Tag, ...]:
    """A place on each tape for its number, away from those already placed: short tapes first."""
    placed: list[Tag] = []
    for name in sorted(numbers, key=view.shown_length):
        candidates = _candidates(view.lines[name])
        # Where nothing is near the middle of the tape is as good as any place.
        free = np.minimum(_distances(candidates, placed), 3.0 * TAG_PX)
        from_middle = np.abs(np.linspace(-1.0, 1.0, len(candidates)))
        x, y = candidates[int(np.argmax(free - TAG_PX * from_middle))].tolist()
        placed.append(Tag(number=numbers[name], x=x, y=y))
    return tuple(sorted(placed, key=lambda tag: tag.number))


def _candidates(lines: Sequence[Points2D]) -> Points2D:
    longest = max(lines, key=len)
    if len(longest) == 2:
        return np.linspace(longest[0], longest[1], _CANDIDATES)
    return longest[np.linspace(0, len(longest) - 1, _CANDIDATES).round().astype(int)]


def _distances(points: Points2D, tags: Sequence[Tag]) -> np.ndarray:
    if not tags:
        return np.full(len(points), np.inf)
    at = np.array([(tag.x, tag.y) for tag in tags])
    return np.linalg.norm(points[:, None] - at, axis=2).min(axis=1)
