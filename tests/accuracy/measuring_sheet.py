"""The pictures of MEASURING.md and of the page: good examples and bad ones, with what checks say.

``python -m tests.accuracy.measuring_sheet`` draws them into ``service/demo_data``: a sheet whose
captions are the codes that the checks answer, and the same tiles without words in one row, which
the page captions itself. Nothing is written where the checks say anything but what an example is
of.
"""

import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter.detection.detector import Detector, installed_detector
from tests.accuracy.capture_examples import Example, examples, said_of
from tests.accuracy.capture_forms import Picture

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
