"""The inputs of a job besides its request: blobs in its own scope, by name."""

from collections.abc import Mapping
from typing import Final, TypeVar

Content = TypeVar("Content")

IMAGE: Final = "image"
MASK: Final = "mask"

REQUEST: Final = "request.json"
"""What the fit was asked to do."""

RESULT: Final = "result.json"
PERSON: Final = "person.npz"
SEGMENTATION: Final = "segmentation.png"
OVERLAY: Final = "overlay.png"
CLIP: Final = "bvh"
"""A motion sent with the request for a derivation."""

TEXTURE: Final = "texture"
"""A painted atlas sent with the request."""

CHART: Final = "chart"
"""A size chart sent with the request, as CSV."""

OF_EACH_PICTURE: Final = (PERSON, IMAGE, MASK, REQUEST, RESULT)
"""What a combined body has copies of, of every fit; a mask is there if it was sent."""


def of_other(name: str, index: int) -> str:
    """The same input of another fit, by that fit's place in the request for a derivation."""
    stem, point, ending = name.partition(".")
    return f"{stem}.{index}{point}{ending}"


def own_and_others(
    inputs: Mapping[str, Content],
) -> tuple[dict[str, Content], tuple[dict[str, Content], ...]]:
    """Tell what is of a job's own fit from what :func:`of_other` named.

    The others come by their places, and their inputs have the names that its own have.
    """
    own = dict(inputs)
    others: list[dict[str, Content]] = []
    while of_other(PERSON, len(others)) in own:
        names = {of_other(name, len(others)): name for name in OF_EACH_PICTURE}
        others.append({name: own.pop(stored) for stored, name in names.items() if stored in own})
    return own, tuple(others)
