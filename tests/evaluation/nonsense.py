"""Pictures and requests in which no person can be measured: what a fit must not take for one.

Each is drawn or composed from a seed. Points are those of a person of the suite, put where a caller
would put them: about the middle of the picture, over what is drawn, or where they do not belong.
"""

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import cv2
import numpy as np
from PIL import Image as PillowImage

from fitter.arrays import Mask
from fitter.request import Click, FitRequest
from fitter.vocabulary.choices import Cues
from tests.evaluation.cases import CASES
from tests.evaluation.drawn_pictures import (
    SIZE,
    Box,
    Picture,
    Rng,
    coded,
    disc,
    dog_picture,
    hills,
    one_shape,
    slab,
    smooth_noise,
)
from tests.evaluation.files import CaseFiles, encoded_mask, read_case
from tests.evaluation.scene import Half
from tests.evaluation.suite import fit_request
from tests.one_picture import changed

DONORS: Mapping[Half, tuple[str, ...]] = {
    Half.TUNING: (
        "man_old_heavy_standing",
        "woman_young_thin_standing",
        "man_young_thin_standing",
    ),
    Half.REPORTING: (
        "man_103_old_heavy_standing",
        "woman_193_young_thin_standing",
        "man_122_middle_aged_middling_standing",
    ),
}
"""Whose points and pictures are used."""

NAMED_KINDS = ("landscape", "circle", "dog", "two in one mask")
"""Kinds that must be recognised, with a detector and without."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Nonsense:
    """One request that has no answer."""

    kind: str
    number: int
    half: Half
    request: FitRequest

    @property
    def name(self) -> str:
        """Kind and number."""
        return f"{self.kind} {self.number}"


def nonsense(half: Half, cues: Cues, *, count: int = 3) -> list[Nonsense]:
    """So many of each kind for one half, with one donor of that half after the other."""
    made: list[Nonsense] = []
    donors = DONORS[half]
    for number in range(count):
        files, other = (
            read_case(CASES[donors[each % len(donors)]]) for each in (number, number - 1)
        )
        for index, (kind, make) in enumerate(_KINDS.items()):
            rng = np.random.default_rng([index, number, half is Half.TUNING])
            request = make(files, other, fit_request(files, cues), rng)
            made.append(Nonsense(kind=kind, number=number, half=half, request=request))
    return made


def _landscape(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    return _drawn(hills(rng), request, _FULL)


def _wall(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    wall = np.full((*SIZE, 3), rng.uniform(80, 200, 3)) + 12.0 * smooth_noise(rng, 40.0)[..., None]
    return _drawn(coded(wall + rng.normal(0.0, 2.0, wall.shape)), request, _FULL)


def _noise(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    colours = np.stack([smooth_noise(rng, 2.0 + 3.0 * rng.random()) for _ in range(3)], axis=-1)
    return _drawn(coded(128.0 + 45.0 * colours), request, _FULL)


def _circle(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, box, _shape = one_shape(rng, disc)
    return _drawn(picture, request, box)


def _circle_mask(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, box, shape = one_shape(rng, disc)
    return changed(_drawn(picture, request, box), mask=encoded_mask(shape))


def _rectangle(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, box, _shape = one_shape(rng, slab)
    return _drawn(picture, request, box)


def _dog(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """A person's points, stretched over the dog."""
    picture, points, _shape = dog_picture(rng)
    places = np.array(list(points.values()))
    box = (*places.min(axis=0), *places.max(axis=0))
    return _drawn(picture, request, box)


def _dog_jointed(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """Points on the dog's own joints: forelegs for arms, hind legs for legs."""
    picture, points, _shape = dog_picture(rng)
    return changed(request, image=_encoded(picture), clicks=_clicks(points), focal_length_px=None)


def _dog_mask(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, points, shape = dog_picture(rng)
    return changed(
        request,
        image=_encoded(picture),
        clicks=_clicks(points),
        mask=encoded_mask(shape),
        focal_length_px=None,
    )


def _mask_of_a_dog(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """The right person's picture and points, the mask of a dog."""
    picture = _decoded(files.image)
    _dog_drawn, _points, shape = dog_picture(rng)
    size = picture.shape[1], picture.shape[0]
    mask = cv2.resize(shape.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST) > 0
    return changed(request, mask=encoded_mask(mask))


def _mask_of_a_box(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    mask = np.zeros_like(files.person_mask)
    rows, columns = np.nonzero(files.person_mask)
    mask[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1] = True
    return changed(request, mask=encoded_mask(mask))


def _two_in_one_mask(
    files: CaseFiles, other: CaseFiles, request: FitRequest, rng: Rng
) -> FitRequest:
    """Two people side by side, both in the mask; points of the left one."""
    beside, masks = side_by_side(files, other, apart=float(rng.uniform(0.45, 1.0)))
    return changed(request, image=beside, mask=encoded_mask(masks[0] | masks[1]))


def _upside_down(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    return changed(request, image=_encoded(_decoded(files.image)[::-1]))


def _mirrored(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    return changed(request, image=_encoded(_decoded(files.image)[:, ::-1]))


def _shifted(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture = _decoded(files.image)
    return changed(request, image=_encoded(np.roll(picture, picture.shape[1] // 2, axis=1)))


def _of_another(_: CaseFiles, other: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """Points of one picture on another one, where that person stands elsewhere."""
    picture = _decoded(other.image)
    moved = np.roll(picture, int(rng.uniform(0.2, 0.3) * picture.shape[1]), axis=1)
    return _drawn(moved, request, None)


def _cluster(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """All points within a tenth of the picture, somewhere in it."""
    left, top = rng.uniform(0.2, 0.7, 2)
    return changed(
        request,
        clicks=placed(
            request.views[0].clicks,
            _scaled((left, top, left + 0.08, top + 0.1), _decoded(request.views[0].image)),
        ),
    )


def _permuted(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """The right places under each other's names."""
    names = list(request.views[0].clicks)
    places = [request.views[0].clicks[names[index]] for index in rng.permutation(len(names))]
    return changed(request, clicks=dict(zip(names, places, strict=True)))


Maker = Callable[[CaseFiles, CaseFiles, FitRequest, Rng], FitRequest]

_KINDS: Mapping[str, Maker] = {
    "landscape": _landscape,
    "wall": _wall,
    "noise": _noise,
    "circle": _circle,
    "circle, masked": _circle_mask,
    "rectangle": _rectangle,
    "dog": _dog,
    "dog, its joints": _dog_jointed,
    "dog, masked": _dog_mask,
    "two in one mask": _two_in_one_mask,
    "mask of a dog": _mask_of_a_dog,
    "mask of a box": _mask_of_a_box,
    "upside down": _upside_down,
    "mirrored": _mirrored,
    "shifted by half": _shifted,
    "points of another": _of_another,
    "points in a cluster": _cluster,
    "points permuted": _permuted,
}

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


def _clicks(points: Mapping[str, tuple[float, float]]) -> dict[str, Click]:
    return {name: Click(x=x, y=y) for name, (x, y) in points.items()}


def _decoded(image: bytes) -> Picture:
    with PillowImage.open(io.BytesIO(image)) as picture:
        return np.asarray(picture.convert("RGB"))


def _encoded(picture: Picture) -> bytes:
    stream = io.BytesIO()
    PillowImage.fromarray(np.ascontiguousarray(picture)).save(stream, "JPEG", quality=90)
    return stream.getvalue()
