"""The names of a fit's files: what was sent, which lies in its own scope, and what came of it."""

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Generic, TypeVar

Content = TypeVar("Content")

RESULT: Final = "result.json"
PERSON: Final = "person.npz"
TAPES: Final = "tapes.json"
BODY: Final = "body.png"
"""The body from the front, the side and the back."""

IMAGE: Final = "image"
MASK: Final = "mask"
SEGMENTATION: Final = "segmentation.png"
OVERLAY: Final = "overlay.png"

CLIP: Final = "bvh"
"""A motion sent with the request for a product."""

CHART: Final = "chart"
"""A size chart sent with the request, as CSV."""


def of_view(number: int, name: str) -> str:
    """A file of one of the pictures, by the picture's place: ``views/0/overlay.png``."""
    return f"views/{number}/{name}"


@dataclass(frozen=True, slots=True)
class SentPicture(Generic[Content]):
    """A picture of the person, and its mask if one came with it."""

    image: Content
    mask: Content | None


def named_pictures(pictures: Sequence[SentPicture[Content]]) -> dict[str, Content]:
    """Pictures by their names, from which :func:`pictures_of` reads them."""
    named: dict[str, Content] = {}
    for number, picture in enumerate(pictures):
        named[of_view(number, IMAGE)] = picture.image
        if picture.mask is not None:
            named[of_view(number, MASK)] = picture.mask
    return named


def pictures_of(files: Mapping[str, Content]) -> tuple[SentPicture[Content], ...]:
    """The pictures among the files of a fit, in their order."""
    numbers = itertools.takewhile(lambda number: of_view(number, IMAGE) in files, itertools.count())
    return tuple(
        SentPicture(files[of_view(number, IMAGE)], files.get(of_view(number, MASK)))
        for number in numbers
    )


def product_inputs(files: Mapping[str, Content]) -> dict[str, Content]:
    """The files of a fit that products are made of, whatever their kind."""
    of_first = (of_view(0, name) for name in (IMAGE, SEGMENTATION))
    overlays = (of_view(number, OVERLAY) for number in range(len(pictures_of(files))))
    names = (PERSON, RESULT, BODY, *of_first, *overlays)
    return {name: files[name] for name in names if name in files}
