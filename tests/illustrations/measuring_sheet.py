"""The pictures of MEASURING.md and of the page: good examples and bad ones, with what checks say.

``python -m tests.illustrations.measuring_sheet`` draws them into ``service/demo_data``: a sheet
whose captions are the codes that the checks answer, and the same tiles without words in one row,
which the page captions itself. Nothing is written where the checks say anything but what an example
is of.
"""

import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.arrays import Mask
from fitter.capture.checking import check_capture
from fitter.detection.detector import Detector, installed_detector
from fitter.fits.capture_check import CaptureQuestion, capture_of
from fitter.observation.decoding import DecodedPicture, decode_picture
from fitter.observation.picture_files import ExifTags
from fitter.vocabulary.choices import ViewKind
from fitter.vocabulary.remarks import Code
from tests.accuracy.cases import CASES
from tests.accuracy.runs import picture_of
from tests.accuracy.spoiling import (
    Picture,
    beside,
    blurred,
    cropped,
    exposed,
    far_away,
    reduced,
    rolled,
)
from tests.accuracy.staging import camera_of, plain_picture

FOLDER = Path(__file__).parents[2] / "service" / "demo_data"
SHEET, TILES = "measuring.jpg", "measuring_tiles.jpg"

COLUMNS = 5
TILE_PX, SMALL_TILE_PX = (210, 280), (120, 160)
CAPTION_PX = 40
GAP_PX = 8

FONT = cv2.FONT_HERSHEY_SIMPLEX
PAPER, INK = 255, (50, 50, 50)
GOOD, BAD = (30, 120, 60), (175, 40, 40)
QUALITY = 82

MAX_PIXELS = 50_000_000

WITHOUT_EXAMPLE = {
    Code.NOBODY_FOUND,
    Code.SKIN_NOT_FOUND,
    Code.FACE_HIDDEN,
    Code.SQUEEZED,
    Code.COVERED,
    Code.NOT_STANDING,
    Code.CHILD,
    Code.CONTRADICTED,
}
"""Everybody in the suite's pictures is grown up and stands, in colour; no check tells what covers
them, or that a fit is contradicted."""

NEAR_M = 1.2
WIDE_MM = 15
"""A camera too near sees the whole person through a phone's wide lens only."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Source:
    """A picture of the suite, its person's true mask and what is asked of it."""

    picture: Picture
    mask: Mask
    question: CaptureQuestion

    @property
    def seen(self) -> tuple[Picture, Mask]:
        """Picture and mask."""
        return self.picture, self.mask


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Example:
    """A picture, what is asked of it, and the code it is an example of; None of a good one."""

    title: str
    code: Code | None
    picture: Picture
    question: CaptureQuestion


def examples() -> list[Example]:
    """Good pictures first, then one of each fault; people of the tuning half alone."""
    woman, man = _source("phone_woman_young_thin_front"), _source("phone_man_old_middling_front")
    plain = _source("phone_man_middle_aged_thin_front")
    old = _source("phone_woman_old_middling_front")

    def fault(title: str, code: Code, picture: Picture, source: Source) -> Example:
        question = replace(source.question, focal_length_px=None)
        return Example(title=title, code=code, picture=picture, question=question)

    return [
        _good("Front", "phone_woman_young_thin_front"),
        _good("Side, arms forward", "phone_woman_young_thin_side"),
        _good("Side, arms hanging", "phone_man_middle_aged_thin_side"),
        fault("Feet cut off", Code.CUT_OFF, cropped(*man.seen, bottom=0.96), man),
        fault("Too far away", Code.PERSON_TOO_SMALL, far_away(*woman.seen, stature_px=200), woman),
        fault("A thumbnail", Code.PICTURE_TOO_SMALL, reduced(*old.seen, stature_px=100), old),
        _too_near("Too near", "phone_man_middle_aged_middling_front"),
        fault("Tilted camera", Code.CAMERA_ROLLED, rolled(plain.picture, degrees=15.0), plain),
        _taken("Turned half away", Code.OTHER_VIEW, "woman_young_thin_turned"),
        _taken("Arms on the body", Code.ARMS_AGAINST_TRUNK, "man_old_middling_turned"),
        _taken("Loose clothes", Code.CLOTHES_LOOSE, "clothed_man_middle_aged_middling"),
        fault("Blurred", Code.BLURRED, blurred(woman.picture, deviation_px=4.0), woman),
        fault("Too dark", Code.TOO_DARK, exposed(plain.picture, factor=0.025), plain),
        fault("Too bright", Code.TOO_BRIGHT, exposed(old.picture, factor=5.0), old),
        fault("Somebody else", Code.SEVERAL_PEOPLE, beside(man.picture, plain.picture), man),
    ]


def said_of(example: Example, detector: Detector) -> list[str]:
    """The codes that the checks answer for an example, in their order."""
    decoded = DecodedPicture(
        pixels=example.picture,
        width=example.picture.shape[1],
        height=example.picture.shape[0],
        stored_width=example.picture.shape[1],
        exif=ExifTags(),
        warnings=(),
    )
    capture = capture_of(decoded, example.question, detector=detector)
    return [finding.code for finding in check_capture(capture).findings]


def _good(title: str, name: str) -> Example:
    source = _source(name)
    return Example(title=title, code=None, picture=source.picture, question=source.question)


def _taken(title: str, code: Code, name: str) -> Example:
    return replace(_good(title, name), code=code)


def _too_near(title: str, name: str) -> Example:
    """Plainly rendered: nobody of the suite is photographed from so near."""
    source, case = _source(name), CASES[name]
    view = replace(case.view, distance_m=NEAR_M, equivalent_mm=WIDE_MM)
    placed = replace(case, view=view)
    return Example(
        title=title,
        code=Code.CAMERA_TOO_NEAR,
        picture=plain_picture(placed, turned_deg=0.0),
        question=replace(source.question, focal_length_px=camera_of(view).focal_length_px),
    )


def _source(name: str) -> Source:
    picture = picture_of(name)
    decoded = decode_picture(picture.request.views[0].image, field="image", max_pixels=MAX_PIXELS)
    view = ViewKind.SIDE if name.endswith("_side") else ViewKind.FRONT
    return Source(
        picture=decoded.pixels,
        mask=picture.person_mask,
        question=CaptureQuestion(
            view=view,
            gender=picture.request.person.gender,
            height_m=picture.request.person.height_m,
            focal_length_px=picture.focal_length_px,
        ),
    )


def captions(shown: Sequence[Example], detector: Detector) -> list[list[str]]:
    """What the checks say of each."""
    return [said_of(example, detector) for example in shown]


def sheet(shown: Sequence[Example], said: Sequence[Sequence[str]]) -> Picture:
    """Rows of captioned tiles; what the checks say stands under a title."""
    cells = [_cell(example, codes) for example, codes in zip(shown, said, strict=True)]
    blank = np.full_like(cells[0], PAPER)
    padded = [*cells, *[blank] * (-len(cells) % COLUMNS)]
    return np.concatenate(
        [
            np.concatenate(padded[start : start + COLUMNS], axis=1)
            for start in range(0, len(padded), COLUMNS)
        ]
    )


def tiles(shown: Sequence[Example]) -> Picture:
    """All examples side by side, small and without words."""
    return np.concatenate([_tile(example.picture, SMALL_TILE_PX) for example in shown], axis=1)


def encoded(picture: Picture) -> bytes:
    """As a JPEG."""
    made, content = cv2.imencode(".jpg", picture[:, :, ::-1], (cv2.IMWRITE_JPEG_QUALITY, QUALITY))
    if not made:
        message = "OpenCV could not encode a picture."
        raise RuntimeError(message)
    return content.tobytes()


def files(shown: Sequence[Example], said: Sequence[Sequence[str]]) -> Mapping[str, bytes]:
    """Both pictures by their names."""
    return {SHEET: encoded(sheet(shown, said)), TILES: encoded(tiles(shown))}


def main(folder: Path) -> int:
    """Draw them; returns the exit status, 1 where an example is none."""
    detector = installed_detector()
    if detector is None:
        print("The detector is not installed: make installs it.", file=sys.stderr)
        return 1
    shown = examples()
    said = captions(shown, detector)
    wrong = False
    for example, codes in zip(shown, said, strict=True):
        meant = [] if example.code is None else [example.code.value]
        print(f"{example.title:20s}{', '.join(codes) or 'nothing'}")
        if codes != meant:
            print(f"  where {', '.join(meant) or 'nothing'} was meant", file=sys.stderr)
            wrong = True
    if wrong:
        return 1
    for name, content in files(shown, said).items():
        (folder / name).write_bytes(content)
    return 0


def _cell(example: Example, codes: Sequence[str]) -> UInt8[np.ndarray, "h w 3"]:
    width, height = TILE_PX
    cell = np.full((height + CAPTION_PX + GAP_PX, width + GAP_PX, 3), PAPER, dtype=np.uint8)
    cell[:height, :width] = _tile(example.picture, TILE_PX)
    colour = BAD if codes else GOOD
    cell[height : height + 3, :width] = colour
    for text, row, ink in (
        (example.title, 17, INK),
        (", ".join(codes) or "good to measure", 34, colour),
    ):
        cv2.putText(cell, text, (2, height + row), FONT, 0.45, ink, 1, cv2.LINE_AA)
    return cell


def _tile(picture: Picture, size: tuple[int, int]) -> Picture:
    """The whole picture in a frame of this width and height, on its own border."""
    width, height = size
    scale = min(width / picture.shape[1], height / picture.shape[0])
    # A thumbnail is shown as coarse as it is.
    how = cv2.INTER_NEAREST if scale > 1.0 else cv2.INTER_AREA
    inner = (round(scale * picture.shape[1]), round(scale * picture.shape[0]))
    small = cv2.resize(picture, inner, interpolation=how)
    rows, columns = height - small.shape[0], width - small.shape[1]
    return np.pad(
        small,
        ((rows // 2, rows - rows // 2), (columns // 2, columns - columns // 2), (0, 0)),
        constant_values=_FRAME,
    )


_FRAME = 225


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER))
