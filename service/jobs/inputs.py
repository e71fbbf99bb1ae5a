"""What a job is made of beside its request: blobs in its own scope, by name."""

from typing import Final

IMAGE: Final = "image"
MASK: Final = "mask"

REQUEST: Final = "request.json"
"""What the fit was asked to do."""

RESULT: Final = "result.json"
PERSON: Final = "person.npz"
SEGMENTATION: Final = "segmentation.png"
OVERLAY: Final = "overlay.png"
CLIP: Final = "bvh"
"""A motion that came along with the request for a derivation."""

TEXTURE: Final = "texture"
"""A painted atlas that came along."""


OF_EACH_PICTURE: Final = (PERSON, IMAGE, MASK, REQUEST)
"""What a combined body has copies of, of every fit; a mask is there if it was sent."""


def of_other(name: str, index: int) -> str:
    """The same input of another fit, by that fit's place in the request for a derivation."""
    stem, point, ending = name.partition(".")
    return f"{stem}.{index}{point}{ending}"
