"""What a job is made of beside its request: blobs in its own scope, by name."""

from collections.abc import Mapping
from typing import Final

from api_schemas.derivations import DerivationKind

IMAGE: Final = "image"
MASK: Final = "mask"

RESULT: Final = "result.json"
PERSON: Final = "person.npz"
SEGMENTATION: Final = "segmentation.png"
OVERLAY: Final = "overlay.png"
CLIP: Final = "bvh"
"""A motion that came along with the request for a derivation."""


def other_person(index: int) -> str:
    """The person of another fit, by its place in the request for a derivation."""
    return f"person.{index}.npz"


OF_ITS_FIT: Final[Mapping[DerivationKind, tuple[str, ...]]] = {
    DerivationKind.ANIMATION: (PERSON,),
    DerivationKind.CARICATURE: (PERSON,),
    DerivationKind.COMBINED: (PERSON, RESULT),
    DerivationKind.FIGURE: (PERSON, IMAGE, OVERLAY),
    DerivationKind.POSE: (PERSON,),
    DerivationKind.TEXTURE: (PERSON, IMAGE, SEGMENTATION),
    DerivationKind.REPORT: (RESULT, PERSON, OVERLAY, "albedo.png", "shading.png"),
}
"""Of which of the fit's inputs and files a derivation has copies, so far as the fit has them."""
