"""Pictures and requests in which no person can be measured: what a fit must not take for one.

Each is drawn or composed from a seed. Points are those of a person of the suite, put where a caller
would put them: about the middle of the picture, over what is drawn, or where they do not belong.
"""

import io
from collections.abc import Callable, Mapping
from dataclasses import replace

import cv2
import numpy as np
from PIL import Image as PillowImage

from fitter.arrays import Mask
from fitter.request import Click, FitRequest
from fitter.vocabulary.choices import Cues
from tests.accuracy.cases import CASES
from tests.accuracy.drawn_pictures import (
    Box,
    Picture,
    Rng,
    coded,
    disc,
    dog_picture,
    hills,
    one_shape,
    smooth_noise,
)
from tests.accuracy.files import CaseFiles, encoded_mask, read_case
from tests.accuracy.suite import fit_request
from tests.one_picture import changed

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
    return _drawn(hills(rng), request, _FULL)


def _noise(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    colours = np.stack([smooth_noise(rng, 2.0 + 3.0 * rng.random()) for _ in range(3)], axis=-1)
    return _drawn(coded(128.0 + 45.0 * colours), request, _FULL)


def _circle(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, box, _shape = one_shape(rng, disc)
    return _drawn(picture, request, box)


def _dog(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """A person's points, stretched over the dog."""
    picture, points, _shape = dog_picture(rng)
    places = np.array(list(points.values()))
    box = (*places.min(axis=0), *places.max(axis=0))
    return _drawn(picture, request, box)


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
    "dog": (6, _dog),
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


def _drawn(picture: Picture, request: FitRequest, box: Box | None) -> FitRequest:
    """The request with another picture: points over a box, pixels or shares; None leaves them."""
    clicks = request.views[0].clicks
    if box is not None:
        clicks = placed(clicks, box if box[2] > 1.0 else _scaled(box, picture))
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
