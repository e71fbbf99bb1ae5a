"""The inputs of a job besides its request: blobs in its own scope, by name."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Generic, NamedTuple, TypeVar

Content = TypeVar("Content")

IMAGE: Final = "image"
MASK: Final = "mask"

REQUEST: Final = "request.json"
"""What the fit was asked to do."""

RESULT: Final = "result.json"
PERSON: Final = "person.npz"
SEGMENTATION: Final = "segmentation.png"
OVERLAY: Final = "overlay.png"
BODY_POSED: Final = "body_posed.glb"
TAPES: Final = "tapes.json"

CLIP: Final = "bvh"
"""A motion sent with the request for a derivation."""

TEXTURE: Final = "texture"
"""A painted atlas sent with the request."""

CHART: Final = "chart"
"""A size chart sent with the request, as CSV."""


def image_of(number: int) -> str:
    """The picture of a view of a scan, by its place in the request; a form's part is called so."""
    return f"{IMAGE}_{number}"


def mask_of(number: int) -> str:
    """The mask that came with it, if one did."""
    return f"{MASK}_{number}"


@dataclass(frozen=True, slots=True)
class SentPicture(Generic[Content]):
    """A picture of the person, and its mask if one came with it."""

    image: Content
    mask: Content | None


class PictureNames(NamedTuple):
    """What a picture and its mask are called: parts of a form, and inputs of a job."""

    image: str
    mask: str


def picture_names(count: int) -> tuple[PictureNames, ...]:
    """The names of so many pictures."""
    if count == 1:
        return (PictureNames(IMAGE, MASK),)
    return tuple(PictureNames(image_of(number), mask_of(number)) for number in range(count))


def named_pictures(pictures: Sequence[SentPicture[Content]]) -> dict[str, Content]:
    """Pictures as inputs of a job, which :func:`pictures_of` reads."""
    named: dict[str, Content] = {}
    for names, picture in zip(picture_names(len(pictures)), pictures, strict=True):
        named[names.image] = picture.image
        if picture.mask is not None:
            named[names.mask] = picture.mask
    return named


def pictures_of(inputs: Mapping[str, Content]) -> tuple[SentPicture[Content], ...]:
    """The pictures among the inputs of a job, in their order: one of a fit, several of a scan."""
    if IMAGE in inputs:
        return (SentPicture(inputs[IMAGE], inputs.get(MASK)),)
    numbers = itertools.takewhile(lambda number: image_of(number) in inputs, itertools.count())
    return tuple(
        SentPicture(inputs[image_of(number)], inputs.get(mask_of(number))) for number in numbers
    )


def file_of(name: str, number: int) -> str:
    """A file that a scan has of each of its views: ``overlay_1.png`` of the second."""
    stem, point, ending = name.partition(".")
    return f"{stem}_{number}{point}{ending}"


OF_FIRST_VIEW: Final[Mapping[str, str]] = {IMAGE: image_of(0), MASK: mask_of(0)} | {
    name: file_of(name, 0) for name in (OVERLAY, SEGMENTATION)
}
"""What a scan has where a fit has its picture and what was made of it; the person of ``person.npz``
stands in the first one too."""
