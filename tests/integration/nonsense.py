"""Pictures and requests in which no person can be measured: what a fit must not take for one.

Each is drawn or composed from a seed. Points are those of a person of the suite, put where a caller
would put them: about the middle of the picture, over what is drawn, or where they do not belong.
"""

import io
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image as PillowImage

from fitter.arrays import Mask
from fitter.request import Click, FitRequest
from fitter.vocabulary.choices import Cues
from tests.accuracy.cases import CASES
from tests.accuracy.files import CaseFiles, encoded_mask, read_case
from tests.accuracy.true_picture import fit_request
from tests.one_picture import changed

Picture = UInt8[np.ndarray, "h w 3"]
Rng = np.random.Generator

Box = tuple[float, float, float, float]
"""Left, top, right and bottom."""

SIZE = (640, 480)
"""Height and width of what is drawn."""

DONORS = ("man_old_heavy_standing", "woman_young_thin_standing", "man_young_thin_standing")
"""Whose points and pictures are used."""


def nonsense(cues: Cues) -> dict[str, FitRequest]:
    """One request of each kind that has no answer."""
    files, other = read_case(CASES[DONORS[0]]), read_case(CASES[DONORS[-1]])
    return {
        kind: make(files, other, fit_request(files, cues), np.random.default_rng([index, 0, 1]))
        for kind, (index, make) in _KINDS.items()
    }


def _landscape(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    return _drawn(hills(rng), _FULL, request)


def _noise(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    colours = np.stack([smooth_noise(rng, 2.0 + 3.0 * rng.random()) for _ in range(3)], axis=-1)
    return _drawn(coded(128.0 + 45.0 * colours), _FULL, request)


def _circle(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    return _drawn(*disc(rng), request)


def _two_in_one_mask(
    files: CaseFiles, other: CaseFiles, request: FitRequest, rng: Rng
) -> FitRequest:
    """Two people side by side, both in the mask; points of the left one."""
    beside, masks = side_by_side(files, other, apart=float(rng.uniform(0.45, 1.0)))
    return changed(request, image=beside, mask=encoded_mask(masks[0] | masks[1]))


Maker = Callable[[CaseFiles, CaseFiles, FitRequest, Rng], FitRequest]

_KINDS: Mapping[str, tuple[int, Maker]] = {
    "landscape": (0, _landscape),
    "noise": (2, _noise),
    "circle": (3, _circle),
    "two in one mask": (9, _two_in_one_mask),
}
"""By kind the seed and the maker."""

_FULL: Box = (0.25, 0.1, 0.75, 0.92)
"""Where people stand, as shares of the picture."""


def side_by_side(
    files: CaseFiles, other: CaseFiles, *, apart: float
) -> tuple[bytes, tuple[Mask, Mask]]:
    """Two pictures joined along a seam, the second one moved in by 1 - ``apart`` of its width.

    Also returns both people's masks on the joined picture; the first picture keeps its pixels.
    """
    first, second = _decoded(files.image), _decoded(other.image)
    height, width = first.shape[:2]
    second = cv2.resize(second, (width, height), interpolation=cv2.INTER_AREA)
    person = cv2.resize(
        other.person_mask.astype(np.uint8), (width, height), interpolation=cv2.INTER_NEAREST
    )
    offset = round(apart * width)
    joined = np.zeros((height, width + offset, 3), np.uint8)
    seen = np.zeros((height, width + offset), bool)
    joined[:, :width] = first
    joined[:, width:] = second[:, width - offset :]
    seen[:, offset:] = person > 0
    joined[seen] = np.pad(second, ((0, 0), (offset, 0), (0, 0)))[seen]
    own = np.pad(files.person_mask, ((0, 0), (0, offset)))
    joined[:, :width][files.person_mask] = first[files.person_mask]
    return _encoded(joined), (own, seen & ~own)


def placed(clicks: Mapping[str, Click], box: Box) -> dict[str, Click]:
    """The same points, stretched over a box (pixels)."""
    places = np.array([(click.x, click.y) for click in clicks.values()])
    low, high = places.min(axis=0), places.max(axis=0)
    shares = (places - low) / (high - low)
    corner, size = np.array(box[:2]), np.array(box[2:]) - np.array(box[:2])
    return {
        name: replace(click, x=float(x), y=float(y))
        for (name, click), (x, y) in zip(clicks.items(), corner + shares * size, strict=True)
    }


def _drawn(picture: Picture, box: Box, request: FitRequest) -> FitRequest:
    """The request with another picture: points over a box, pixels or shares."""
    box = box if box[2] > 1.0 else _scaled(box, picture)
    clicks = placed(request.views[0].clicks, box)
    height, width = picture.shape[:2]
    clicks = {
        name: replace(click, x=min(click.x, float(width)), y=min(click.y, float(height)))
        for name, click in clicks.items()
    }
    return changed(request, image=_encoded(picture), clicks=clicks, focal_length_px=None)


def _scaled(box: Box, picture: Picture) -> Box:
    height, width = picture.shape[:2]
    left, top, right, bottom = box
    return left * width, top * height, right * width, bottom * height


def _decoded(image: bytes) -> Picture:
    with PillowImage.open(io.BytesIO(image)) as picture:
        return np.asarray(picture.convert("RGB"))


def _encoded(picture: Picture) -> bytes:
    stream = io.BytesIO()
    PillowImage.fromarray(np.ascontiguousarray(picture)).save(stream, "JPEG", quality=90)
    return stream.getvalue()


def hills(rng: Rng) -> Picture:
    """Four ridges under a sky."""
    height, width = SIZE
    rows = np.linspace(0.0, 1.0, height)[:, None]
    sky = np.array([110.0, 160.0, 225.0]) + rows[..., None] * rng.uniform(10.0, 90.0, 3)
    picture = np.broadcast_to(sky, (height, width, 3)).copy()
    for index, level in enumerate(np.sort(rng.uniform(0.35, 0.85, 4))):
        along = np.cumsum(rng.normal(0.0, 1.0, width))
        along = cv2.GaussianBlur(along[None], (0, 0), 18.0)[0]
        ridge = level + 0.12 * (along - along.mean()) / (along.std() + 1e-9) * (1.0 - level)
        ground = rows >= ridge[None]
        tone = np.array([40.0, 80.0, 35.0]) * (1.4 - 0.25 * index) + rng.uniform(0.0, 50.0, 3)
        texture = (
            14.0 * smooth_noise(rng, 2.5)[..., None] + 10.0 * smooth_noise(rng, 15.0)[..., None]
        )
        picture = np.where(ground[..., None], tone + texture, picture)
    return coded(picture + rng.normal(0.0, 2.0, picture.shape))


def disc(rng: Rng) -> tuple[Picture, Box]:
    """A disc before a wall: picture, and box for the points within it."""
    height, width = SIZE
    centre = np.array([width, height]) * rng.uniform(0.45, 0.55, 2)
    half = np.array([rng.uniform(0.16, 0.4), 0.4]) * [width, height]
    left, top, right, bottom = (*(centre - half), *(centre + half))
    radius = round(min(0.5 * (bottom - top), 0.45 * width))
    middle = round(0.5 * (left + right)), round(0.5 * (top + bottom))
    shape = cv2.circle(np.zeros(SIZE, np.uint8), middle, radius, 1, -1) > 0
    colours = rng.uniform(30.0, 225.0, (2, 3))
    picture = np.where(shape[..., None], colours[0], colours[1])
    picture = cv2.GaussianBlur(picture, (0, 0), 0.8) + rng.normal(0.0, 2.0, picture.shape)
    rows, columns = np.nonzero(shape)
    tight = (columns.min(), rows.min(), columns.max(), rows.max())
    left, top, right, bottom = (float(each) for each in tight)
    inset = 0.08 * (bottom - top)
    return coded(picture), (left + inset, top + inset, right - inset, bottom - inset)


def smooth_noise(rng: Rng, spread: float) -> Float[np.ndarray, "h w"]:
    """Noise of unit variance, correlated over ``spread`` pixels."""
    blurred = cv2.GaussianBlur(rng.normal(0.0, 1.0, SIZE), (0, 0), spread)
    return blurred / blurred.std()


def coded(values: Any) -> Picture:
    """As 8-bit values."""
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)
