"""What a job is made of beside its request: blobs in its own scope, by name."""

from collections.abc import Mapping
from typing import Final

from api_schemas.derivations import DerivationKind

IMAGE: Final = "image"
MASK: Final = "mask"

RESULT: Final = "result.json"
PERSON: Final = "person.npz"

OF_ITS_FIT: Final[Mapping[DerivationKind, tuple[str, ...]]] = {
    DerivationKind.CARICATURE: (PERSON,),
    DerivationKind.POSE: (PERSON,),
    DerivationKind.REPORT: (RESULT, PERSON, "overlay.png", "albedo.png", "shading.png"),
}
"""Which files of the fit's result a derivation has copies of, so far as the fit has them."""
