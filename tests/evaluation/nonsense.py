"""Pictures and requests in which no person can be measured: what a fit must not take for one.

Each is drawn or composed from a seed. Points are those of a person of the suite, put where a caller
would put them: about the middle of the picture, over what is drawn, or where they do not belong.
"""

import io
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from PIL import Image as PillowImage

from fitter.arrays import Mask
from fitter.request import Click, Cues, FitRequest
from tests.evaluation.cases import CASES
from tests.evaluation.files import CaseFiles, encoded_mask, read_case
from tests.evaluation.scene import Half
from tests.evaluation.suite import fit_request

Picture = UInt8[np.ndarray, "h w 3"]
Rng = np.random.Generator

SIZE = (640, 480)
"""Height and width of what is drawn."""

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
    return _drawn(_hills(rng), request, _FULL)


def _wall(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    wall = np.full((*SIZE, 3), rng.uniform(80, 200, 3)) + 12.0 * _smooth_noise(rng, 40.0)[..., None]
    return _drawn(_coded(wall + rng.normal(0.0, 2.0, wall.shape)), request, _FULL)


def _noise(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    colours = np.stack([_smooth_noise(rng, 2.0 + 3.0 * rng.random()) for _ in range(3)], axis=-1)
    return _drawn(_coded(128.0 + 45.0 * colours), request, _FULL)


def _circle(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, box, _shape = _one_shape(rng, _disc)
    return _drawn(picture, request, box)


def _circle_mask(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, box, shape = _one_shape(rng, _disc)
    return replace(_drawn(picture, request, box), mask=encoded_mask(shape))


def _rectangle(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, box, _shape = _one_shape(rng, _slab)
    return _drawn(picture, request, box)


def _dog(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """A person's points, stretched over the dog."""
    picture, points, _shape = _dog_picture(rng)
    places = np.array(list(points.values()))
    box = (*places.min(axis=0), *places.max(axis=0))
    return _drawn(picture, request, box)


def _dog_jointed(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """Points on the dog's own joints: forelegs for arms, hind legs for legs."""
    picture, points, _shape = _dog_picture(rng)
    return replace(request, image=_encoded(picture), clicks=_clicks(points), focal_length_px=None)


def _dog_mask(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture, points, shape = _dog_picture(rng)
    return replace(
        request,
        image=_encoded(picture),
        clicks=_clicks(points),
        mask=encoded_mask(shape),
        focal_length_px=None,
    )


def _mask_of_a_dog(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """The right person's picture and points, the mask of a dog."""
    picture = _decoded(files.image)
    _dog_drawn, _points, shape = _dog_picture(rng)
    size = picture.shape[1], picture.shape[0]
    mask = cv2.resize(shape.astype(np.uint8), size, interpolation=cv2.INTER_NEAREST) > 0
    return replace(request, mask=encoded_mask(mask))


def _mask_of_a_box(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    mask = np.zeros_like(files.person_mask)
    rows, columns = np.nonzero(files.person_mask)
    mask[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1] = True
    return replace(request, mask=encoded_mask(mask))


def _two_in_one_mask(
    files: CaseFiles, other: CaseFiles, request: FitRequest, rng: Rng
) -> FitRequest:
    """Two people side by side, both in the mask; points of the left one."""
    beside, masks = side_by_side(files, other, apart=float(rng.uniform(0.45, 1.0)))
    return replace(request, image=beside, mask=encoded_mask(masks[0] | masks[1]))


def _upside_down(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    return replace(request, image=_encoded(_decoded(files.image)[::-1]))


def _mirrored(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    return replace(request, image=_encoded(_decoded(files.image)[:, ::-1]))


def _shifted(files: CaseFiles, _: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    picture = _decoded(files.image)
    return replace(request, image=_encoded(np.roll(picture, picture.shape[1] // 2, axis=1)))


def _of_another(_: CaseFiles, other: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """Points of one picture on another one, where that person stands elsewhere."""
    picture = _decoded(other.image)
    moved = np.roll(picture, int(rng.uniform(0.2, 0.3) * picture.shape[1]), axis=1)
    return _drawn(moved, request, None)


def _cluster(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """All points within a tenth of the picture, somewhere in it."""
    left, top = rng.uniform(0.2, 0.7, 2)
    return replace(
        request,
        clicks=placed(
            request.clicks, _scaled((left, top, left + 0.08, top + 0.1), _decoded(request.image))
        ),
    )


def _permuted(_: CaseFiles, __: CaseFiles, request: FitRequest, rng: Rng) -> FitRequest:
    """The right places under each other's names."""
    names = list(request.clicks)
    places = [request.clicks[names[index]] for index in rng.permutation(len(names))]
    return replace(request, clicks=dict(zip(names, places, strict=True)))


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

Box = tuple[float, float, float, float]
"""Left, top, right and bottom."""

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
    clicks = request.clicks
    if box is not None:
        clicks = placed(clicks, box if box[2] > 1.0 else _scaled(box, picture))
    height, width = picture.shape[:2]
    clicks = {
        name: replace(click, x=min(click.x, float(width)), y=min(click.y, float(height)))
        for name, click in clicks.items()
    }
    return replace(request, image=_encoded(picture), clicks=clicks, focal_length_px=None)


def _scaled(box: Box, picture: Picture) -> Box:
    height, width = picture.shape[:2]
    left, top, right, bottom = box
    return left * width, top * height, right * width, bottom * height


def _hills(rng: Rng) -> Picture:
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
            14.0 * _smooth_noise(rng, 2.5)[..., None] + 10.0 * _smooth_noise(rng, 15.0)[..., None]
        )
        picture = np.where(ground[..., None], tone + texture, picture)
    return _coded(picture + rng.normal(0.0, 2.0, picture.shape))


def _one_shape(
    rng: Rng, draw: Callable[[np.ndarray, Box], np.ndarray]
) -> tuple[Picture, Box, Mask]:
    height, width = SIZE
    centre = np.array([width, height]) * rng.uniform(0.45, 0.55, 2)
    half = np.array([rng.uniform(0.16, 0.4), 0.4]) * [width, height]
    box = (*(centre - half), *(centre + half))
    shape = draw(np.zeros(SIZE, np.uint8), box) > 0
    colours = rng.uniform(30.0, 225.0, (2, 3))
    picture = np.where(shape[..., None], colours[0], colours[1])
    picture = cv2.GaussianBlur(picture, (0, 0), 0.8) + rng.normal(0.0, 2.0, picture.shape)
    rows, columns = np.nonzero(shape)
    tight = (columns.min(), rows.min(), columns.max(), rows.max())
    left, top, right, bottom = (float(each) for each in tight)
    inset = 0.08 * (bottom - top)
    return _coded(picture), (left + inset, top + inset, right - inset, bottom - inset), shape


def _disc(canvas: np.ndarray, box: Box) -> np.ndarray:
    left, top, right, bottom = box
    centre = round(0.5 * (left + right)), round(0.5 * (top + bottom))
    radius = round(min(0.5 * (bottom - top), 0.45 * SIZE[1]))
    return cv2.circle(canvas, centre, radius, 1, -1)


def _slab(canvas: np.ndarray, box: Box) -> np.ndarray:
    left, top, right, bottom = (round(each) for each in box)
    return cv2.rectangle(canvas, (left, top), (right, bottom), 1, -1)


def _dog_picture(
    rng: Rng,
) -> tuple[Picture, dict[str, tuple[float, float]], Mask]:
    """A dog seen from the side: picture, points of its joints by a person's names, and mask."""
    height, width = SIZE
    scale = width * rng.uniform(0.28, 0.36)
    middle = np.array([0.5 * width, 0.52 * height]) + rng.uniform(-15.0, 15.0, 2)
    swing = rng.uniform(-0.08, 0.08, 4)

    def at(x: float, y: float) -> tuple[float, float]:
        return float(middle[0] + scale * x), float(middle[1] + scale * y)

    legs = {
        "left_arm": (at(0.72, 0.15), at(0.72 + swing[0], 0.62), at(0.74 + swing[0], 1.05)),
        "right_arm": (at(0.55, 0.15), at(0.52 + swing[1], 0.62), at(0.5 + swing[1], 1.05)),
        "left_leg": (at(-0.6, 0.12), at(-0.55 + swing[2], 0.62), at(-0.68 + swing[2], 1.05)),
        "right_leg": (at(-0.75, 0.12), at(-0.8 + swing[3], 0.62), at(-0.9 + swing[3], 1.05)),
    }
    shape = np.zeros(SIZE, np.uint8)
    _ellipse(shape, at(0.0, 0.0), (0.85 * scale, 0.3 * scale), 0.0)
    _ellipse(shape, at(0.95, -0.4), (0.3 * scale, 0.22 * scale), 20.0)
    _ellipse(shape, at(1.15, -0.32), (0.22 * scale, 0.11 * scale), 10.0)
    _ellipse(shape, at(0.8, -0.45), (0.09 * scale, 0.22 * scale), 15.0)
    _stroke(shape, (at(0.65, -0.05), at(0.9, -0.4)), 0.3 * scale)
    _stroke(shape, (at(-0.8, -0.1), at(-1.05, -0.35), at(-1.15, -0.65)), 0.09 * scale)
    for leg in legs.values():
        _stroke(shape, leg, 0.15 * scale)
    points = {"nose": at(1.3, -0.32), "left_eye": at(1.0, -0.48), "head_top": at(0.85, -0.62)}
    for limb, joints in legs.items():
        side, kind = limb.split("_")
        names = ("shoulder", "elbow", "wrist") if kind == "arm" else ("hip", "knee", "ankle")
        points |= {f"{side}_{name}": place for name, place in zip(names, joints, strict=True)}
    fur = rng.uniform(30.0, 160.0, 3) + 14.0 * _smooth_noise(rng, 2.0)[..., None]
    lawn = np.array([90.0, 150.0, 70.0]) + rng.uniform(-20.0, 60.0, 3)
    ground = lawn + 12.0 * _smooth_noise(rng, 5.0)[..., None]
    picture = cv2.GaussianBlur(np.where(shape[..., None] > 0, fur, ground), (0, 0), 0.7)
    inside = {
        name: (min(max(x, 1.0), width - 1.0), min(max(y, 1.0), height - 1.0))
        for name, (x, y) in points.items()
    }
    return _coded(picture), inside, shape > 0


def _ellipse(
    canvas: np.ndarray, centre: tuple[float, float], axes: tuple[float, float], degrees: float
) -> None:
    middle = round(centre[0]), round(centre[1])
    cv2.ellipse(canvas, middle, (round(axes[0]), round(axes[1])), degrees, 0, 360, 1, -1)


def _stroke(canvas: np.ndarray, places: tuple[tuple[float, float], ...], width: float) -> None:
    line = np.array([(round(x), round(y)) for x, y in places], np.int32)
    cv2.polylines(canvas, [line], False, 1, max(round(width), 1))


def _smooth_noise(rng: Rng, spread: float) -> Float[np.ndarray, "h w"]:
    """Noise of unit variance, correlated over ``spread`` pixels."""
    blurred = cv2.GaussianBlur(rng.normal(0.0, 1.0, SIZE), (0, 0), spread)
    return blurred / blurred.std()


def _clicks(points: Mapping[str, tuple[float, float]]) -> dict[str, Click]:
    return {name: Click(x=x, y=y) for name, (x, y) in points.items()}


def _coded(values: Any) -> Picture:
    return np.clip(np.rint(values), 0, 255).astype(np.uint8)


def _decoded(image: bytes) -> Picture:
    with PillowImage.open(io.BytesIO(image)) as picture:
        return np.asarray(picture.convert("RGB"))


def _encoded(picture: Picture) -> bytes:
    stream = io.BytesIO()
    PillowImage.fromarray(np.ascontiguousarray(picture)).save(stream, "JPEG", quality=90)
    return stream.getvalue()
