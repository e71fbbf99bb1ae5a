"""The same picture again, changed by what nobody sees: how far do measurements move?

A fit that is stable gives the same body to well within the error that it states. Pictures are saved
again, cropped by a few pixels, made one per cent smaller and one grey level brighter.
"""

import io
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image as PillowImage

from fitter.errors import FitterError
from fitter.fits.pipeline import fit
from fitter.request import Click, FitRequest
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues, Gender
from tests.evaluation.cases import CASES, PEOPLE
from tests.evaluation.dressed import dressed_names
from tests.evaluation.foreign import foreign_names
from tests.evaluation.runs import picture_of
from tests.evaluation.scene import Half, Series
from tests.evaluation.table import MEASUREMENTS
from tests.one_picture import changed, one_picture
from tests.shared_data import SHARED_DATA

FOLDER = SHARED_DATA / "real"
PAINTING = "durer_adam_1507"
PHOTOGRAPHS: Mapping[str, Gender] = {
    "photo_00": Gender.MALE,
    "photo_01": Gender.FEMALE,
    "photo_04": Gender.MALE,
    "photo_06": Gender.FEMALE,
    "photo_07": Gender.MALE,
}
"""Who is shown where nothing else is known."""

QUALITIES = (98, 92, 86)
CROPS_PX = (1, 2, 3)
SMALLER = 0.99

COMPARED = [each for each in MEASUREMENTS if each[0] != "navel"]

Picture = UInt8[np.ndarray, "h w 3"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Asked:
    """A picture by name, with its points clicked or all proposed."""

    picture: str
    proposed: bool


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Again:
    """One picture and its variants, by some cues.

    Attributes
    ----------
    values
        (variants, measurements) in the order of :data:`COMPARED`.
    standard_errors
        (measurements,) that the fit of the picture itself states.
    """

    asked: Asked
    cues: Cues
    values: Float[np.ndarray, "variants k"]
    standard_errors: Float[np.ndarray, " k"]

    @property
    def spread(self) -> Float[np.ndarray, " k"]:
        """(measurements,) standard deviation over the variants."""
        return self.values.std(axis=0, ddof=1)

    @property
    def set(self) -> str:
        """Of whom the picture is."""
        return set_of(self.asked.picture)


def set_of(name: str) -> str:
    """The set a picture's figures belong to."""
    if name in PHOTOGRAPHS or name == PAINTING:
        return "real"
    return picture_of(name).series.value


def variants(request: FitRequest) -> list[FitRequest]:
    """A request of one picture and eight that nobody could tell from it by eye."""
    picture, kept = _decoded(request.views[0].image)
    height, width = picture.shape[:2]
    saved = [changed(request, image=_jpeg(picture, kept, quality)) for quality in QUALITIES]
    cropped = [
        _moved(request, _png(picture[by:-by, by:-by], kept), scale=1.0, by=float(by))
        for by in CROPS_PX
    ]
    size = round(SMALLER * width), round(SMALLER * height)
    smaller = cv2.resize(picture, size, interpolation=cv2.INTER_AREA)
    brighter = np.minimum(picture, 254) + 1
    return [
        request,
        *saved,
        *cropped,
        _moved(request, _png(smaller, kept), scale=size[0] / width, by=0.0),
        changed(request, image=_png(brighter, kept)),
    ]


def again(asked: Asked) -> list[Again]:
    """By outline alone and with shading; nothing where the picture cannot be fitted.

    The minimum of E1, from which a fit with shading goes on, is what a fit by outline alone finds.
    """
    request = _request(asked)
    try:
        fits = [fit(each) for each in variants(request)]
        plain = fit(changed(request, cues=Cues.SE))
    except FitterError as error:
        print(f"{asked.picture}: {error}", flush=True)
        return []
    keys = [key for _, key, _ in COMPARED]
    return [
        Again(
            asked=asked,
            cues=cues,
            values=np.array([_values(each, cues, keys) for each in fits]),
            standard_errors=_errors(stated, keys),
        )
        for cues, stated in ((Cues.SE, plain), (Cues.SES, fits[0]))
    ]


def pictures_again(*, every: bool, half: Half | None = None) -> list[str]:
    """A picture each of six own people, six foreign and four dressed; or all; and photographs."""
    own = [
        name
        for name, case in CASES.items()
        if case.series is Series.PEOPLE and half in (None, PEOPLE[case.person].half)
    ]
    foreign, dressed = foreign_names(half), dressed_names()
    real = [PAINTING, *PHOTOGRAPHS]
    real = [name for name in real if _file(name).exists()]
    if not every:
        own, foreign, dressed = _spread(own, 6), _spread(foreign, 6), _spread(dressed, 4)
    return [*own, *foreign, *dressed, *real]


def asked_again(names: Sequence[str]) -> list[Asked]:
    """With the points clicked, where they are known, and proposed."""
    return [
        Asked(picture=name, proposed=proposed)
        for name in names
        for proposed in (False, True)
        if proposed or name not in PHOTOGRAPHS
    ]


def again_heading() -> str:
    """Above :func:`again_lines`."""
    return f"{'spread/stated error':45s}{'points':9s}{'cues':5s}" + "".join(
        f"{f'{name} {unit}':>16s}" for name, _, unit in COMPARED
    )


def again_lines(found: Sequence[Again]) -> list[str]:
    """One line a picture and cue."""
    return [_line(each) for each in found]


def again_summary(found: Sequence[Again]) -> list[str]:
    """By set, points and cues: the root mean square of spreads, and the worst ratio to an error."""
    lines = [
        f"{'set':10s}{'points':9s}{'cues':5s}{'pictures':>9s}"
        + "".join(f"{f'{name} {unit}':>12s}{'worst':>6s}" for name, _, unit in COMPARED)
    ]
    sets = list(dict.fromkeys(each.set for each in found))
    for title in [*sets, "all"]:
        for proposed in (False, True):
            for cues in (Cues.SE, Cues.SES):
                these = [
                    each
                    for each in found
                    if title in (each.set, "all")
                    and each.asked.proposed is proposed
                    and each.cues is cues
                ]
                if these:
                    lines.append(_summary_line(title, these))
    return lines


def _summary_line(title: str, these: Sequence[Again]) -> str:
    spreads = np.array([each.spread for each in these])
    ratios = spreads / np.array([each.standard_errors for each in these])
    line = f"{title:10s}{_points(these[0].asked):9s}{these[0].cues.value:5s}{len(these):9d}"
    typical, worst = np.sqrt(np.mean(spreads**2, axis=0)), ratios.max(axis=0)
    return line + "".join(f"{a:12.2f}{b:6.2f}" for a, b in zip(typical, worst, strict=True))


def _line(each: Again) -> str:
    line = f"{each.asked.picture:45s}{_points(each.asked):9s}{each.cues.value:5s}"
    return line + "".join(
        f"{f'{spread:.2f}/{error:.1f}={spread / error:.2f}':>16s}"
        for spread, error in zip(each.spread, each.standard_errors, strict=True)
    )


def _points(asked: Asked) -> str:
    return "proposed" if asked.proposed else "clicked"


def _request(asked: Asked) -> FitRequest:
    request = _real(asked.picture) if set_of(asked.picture) == "real" else None
    request = picture_of(asked.picture).request if request is None else request
    if not asked.proposed:
        return request
    return changed(request, clicks={}, complete_clicks=True)


def _file(name: str) -> Path:
    return FOLDER / f"{name}.jpg" if name == PAINTING else FOLDER / "photos" / f"{name}.jpg"


def _real(name: str) -> FitRequest:
    image = _file(name).read_bytes()
    if name in PHOTOGRAPHS:
        return one_picture(image=image, clicks={}, gender=PHOTOGRAPHS[name], force=True)
    said = json.loads(_file(name).with_suffix(".json").read_text())
    return one_picture(
        image=image,
        clicks={name: Click(x=x, y=y) for name, (x, y, *_) in said["points"].items()},
        gender=Gender(said["gender"]),
        height_m=said["height_m"],
        force=True,
    )


def _moved(request: FitRequest, image: bytes, *, scale: float, by: float) -> FitRequest:
    """With another picture, its points and focal length as they are there."""
    view = request.views[0]
    focal = view.focal_length_px
    return changed(
        request,
        image=image,
        clicks={
            name: replace(click, x=scale * (click.x - by), y=scale * (click.y - by))
            for name, click in view.clicks.items()
        },
        focal_length_px=None if focal is None else scale * focal,
    )


def _decoded(image: bytes) -> tuple[Picture, PillowImage.Exif]:
    with PillowImage.open(io.BytesIO(image)) as picture:
        return np.asarray(picture.convert("RGB")), picture.getexif()


def _jpeg(picture: Picture, exif: PillowImage.Exif, quality: int) -> bytes:
    stream = io.BytesIO()
    PillowImage.fromarray(picture).save(stream, "JPEG", quality=quality, exif=exif)
    return stream.getvalue()


def _png(picture: Picture, exif: PillowImage.Exif) -> bytes:
    stream = io.BytesIO()
    PillowImage.fromarray(picture).save(stream, "PNG", exif=exif, compress_level=1)
    return stream.getvalue()


def _values(result: FitResult, cues: Cues, keys: Sequence[str]) -> list[float]:
    stages = {stage.name: stage.measurements for stage in result.stages}
    # Where shading tells nothing, a fit ends with the minimum of E1.
    chosen = stages.get(cues.value, result.measurements)
    values = {each.name: each.value for each in chosen}
    return [values[key] for key in keys]


def _errors(result: FitResult, keys: Sequence[str]) -> Float[np.ndarray, " k"]:
    found = {each.name: each.standard_error for each in result.measurements}
    return np.array([found[key] for key in keys], dtype=float)


def _spread(names: Sequence[str], count: int) -> list[str]:
    """So many at even steps; all where there are fewer."""
    if len(names) <= count:
        return list(names)
    places = np.linspace(0, len(names) - 1, count).round().astype(int)
    return [names[int(place)] for place in places]
