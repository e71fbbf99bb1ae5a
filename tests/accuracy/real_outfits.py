"""Real people in two outfits each, whose bodies nobody knows: do both show one body?

A folder holds `people.json` and the pictures `PERSON_OUTFIT_SIDE_img.png` with label maps, as the
script beside the repository's shared data cuts them. All of a person are fitted with one guessed
height, so that outer minus inner, and back minus front, is zero within what both fits state.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Final

import numpy as np
from jaxtyping import Float
from PIL import Image as PillowImage

from fitter.fits.pipeline import fit
from fitter.vocabulary.choices import Clothing, Gender
from tests.accuracy.runs import of_each
from tests.accuracy.scene import Label
from tests.accuracy.seen_labels import CLASSES, Labels, label_overlaps, seen_parts
from tests.accuracy.table import MEASUREMENTS
from tests.one_picture import one_picture

OUTFITS: Final = ("Inner", "Outer")
SIDES: Final = ("front", "back")

COLOURS: Final[Mapping[Label, Sequence[tuple[int, int, int]]]] = {
    Label.SKIN: [(128, 128, 128)],
    Label.HAIR: [(255, 128, 0)],
    Label.UPPER: [(180, 50, 50), (0, 128, 255)],
    Label.LOWER: [(50, 180, 50)],
    Label.SHOES: [(128, 0, 255)],
}
"""Colours of the label maps, to within some units; what is worn over a top counts as one."""

_People = Mapping[str, Mapping[str, str]]
_WITHIN = 60.0
_DEVIATIONS = 1.96


@dataclass(frozen=True, slots=True, kw_only=True)
class Dressed:
    """A fit of one person in one outfit.

    ``values`` and ``errors`` are measurements and what the fit states, by name; ``findings`` the
    codes of what it found wrong; ``overlaps`` those of labels.
    """

    person: str
    gender: Gender
    outfit: str
    values: Mapping[str, float]
    errors: Mapping[str, float]
    findings: Sequence[str]
    overlaps: Mapping[str, float | None]


def outfit_tables(folder: Path, clothing: Clothing, jobs: int) -> list[str]:
    """Fits of everybody in both outfits from the front and from behind, and what they differ by."""
    people = json.loads((folder / "people.json").read_text())
    asked = [(side, *each) for side in SIDES for each in product(sorted(people), OUTFITS)]
    fits = list(of_each(partial(_fitted, folder, people, clothing), asked, jobs))
    front, back = fits[: len(fits) // 2], fits[len(fits) // 2 :]
    lines = ["front", *outfit_lines(front), "", "back", *outfit_lines(back)]
    for at, outfit in enumerate(OUTFITS):
        lines += difference_lines(f"back minus front, {outfit}", front[at::2], back[at::2])
    return lines


def _fitted(folder: Path, people: _People, clothing: Clothing, asked: tuple[str, ...]) -> Dressed:
    side, person, outfit = asked
    gender = Gender(people[person]["gender"])
    stem = folder / f"{person}_{outfit}_{side}"
    image = Path(f"{stem}_img.png").read_bytes()
    request = one_picture(
        image=image,
        clicks={},
        complete_clicks=True,
        gender=gender,
        height_m=float(people[person]["height_m"]),
        clothing=clothing,
        force=True,
    )
    result = fit(request)
    true = _labels(Path(f"{stem}_lab.png"))
    found = {each.name: each for each in result.measurements}
    return Dressed(
        person=person,
        gender=gender,
        outfit=outfit,
        values={key: found[key].value for _, key, _ in MEASUREMENTS},
        errors={key: found[key].standard_error or 0.0 for _, key, _ in MEASUREMENTS},
        findings=[each.code for each in result.found.findings],
        overlaps=label_overlaps(seen_parts(image), true),
    )


def _labels(path: Path) -> Labels:
    picture = np.asarray(PillowImage.open(path).convert("RGB")).astype(np.float32)
    found = np.zeros(picture.shape[:2], dtype=np.uint8)
    for label, colours in COLOURS.items():
        for colour in colours:
            found[np.linalg.norm(picture - np.float32(colour), axis=2) < _WITHIN] = label
    return found


def outfit_lines(fits: Sequence[Dressed]) -> list[str]:
    """One line each, then by how much a garment moves what is measured, and the labels."""
    inner, outer = ([each for each in fits if each.outfit == outfit] for outfit in OUTFITS)
    lines = [*map(_line, fits), *difference_lines("outer minus inner outfit", inner, outer)]
    for gender, outfit in product(Gender, OUTFITS):
        of = [each for each in fits if (each.gender, each.outfit) == (gender, outfit)]
        means = [
            f"{name} {np.mean([each.values[key] for each in of]):.1f} {unit}"
            for name, key, unit in (MEASUREMENTS if of else ())
        ]
        lines.append(f"{gender.value} {outfit} {len(of)}: {', '.join(means)}")
    told = [
        f"{name} {np.mean(shares):.2f}"
        for name in CLASSES
        if (shares := [share for each in fits if (share := each.overlaps[name]) is not None])
    ]
    return [*lines, f"labels, intersection over union: {', '.join(told)}"]


def difference_lines(title: str, first: Sequence[Dressed], second: Sequence[Dressed]) -> list[str]:
    """How far apart two fits of the same people are."""
    lines = ["", f"{title}, {len(first)} pairs"]
    for name, key, unit in MEASUREMENTS:
        values, errors = (
            np.array([[getattr(each, of)[key] for each in these] for these in (first, second)])
            for of in ("values", "errors")
        )
        apart = values[1] - values[0]
        held = np.mean(np.abs(apart) <= _DEVIATIONS * np.hypot(*errors))
        lines.append(
            f"{f'{name} {unit}':12s} mean {apart.mean():+5.1f}, "
            f"absolute {np.abs(apart).mean():4.1f}, worst {np.abs(apart).max():3.0f}; "
            f"within {_DEVIATIONS} stated {held:.0%}; correlation within sex "
            f"{_correlation(first, values):.2f}; stated {errors[0].mean():.1f}, "
            f"{errors[1].mean():.1f}"
        )
    return lines


def _line(each: Dressed) -> str:
    told = " ".join(
        f"{name} {each.values[key]:.0f} ({each.errors[key]:.1f})" for name, key, _ in MEASUREMENTS
    )
    return f"{each.person} {each.outfit} {each.gender.value:6s} {told}  {' '.join(each.findings)}"


def _correlation(people: Sequence[Dressed], values: Float[np.ndarray, "2 k"]) -> float:
    """Correlation of both outfits' values over people, about the means of their sex."""
    men = np.array([each.gender is Gender.MALE for each in people])
    for these in (men, ~men):
        if these.any():
            values[:, these] -= values[:, these].mean(axis=1, keepdims=True)
    return float(np.corrcoef(values)[0, 1])
