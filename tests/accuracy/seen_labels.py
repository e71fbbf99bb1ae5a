"""What the network of worn parts sees, by pixel, against what a picture shows."""

from collections.abc import Mapping
from io import BytesIO

import numpy as np
from jaxtyping import UInt8
from PIL import Image as PillowImage
from PIL import ImageOps

from fitter.detection.detector import installed_detector
from fitter.detection.worn_parts import WornPart, installed_worn_parts
from tests.accuracy.scene import Label

CLASSES: Mapping[str, tuple[frozenset[WornPart], frozenset[Label]]] = {
    "skin": (frozenset({WornPart.SKIN}), frozenset({Label.SKIN})),
    "hair": (frozenset({WornPart.HAIR}), frozenset({Label.HAIR})),
    "cloth": (
        frozenset({WornPart.CLOTH, WornPart.OUTER}),
        frozenset({Label.UPPER, Label.LOWER}),
    ),
    "shoes": (frozenset({WornPart.SHOES}), frozenset({Label.SHOES})),
}

Labels = UInt8[np.ndarray, "h w"]


def seen_parts(image: bytes) -> Labels:
    """The most probable :class:`WornPart` at each pixel, of the first person in a picture file."""
    with PillowImage.open(BytesIO(image)) as opened:
        pixels = np.asarray(ImageOps.exif_transpose(opened).convert("RGB"))
    person = installed_detector().bodies(pixels)[0].person
    return installed_worn_parts().maps(pixels, person).argmax(axis=2).astype(np.uint8)


def label_overlaps(seen: Labels, true: Labels) -> dict[str, float | None]:
    """Intersection over union by class; None of what is not there."""
    overlaps: dict[str, float | None] = {}
    for name, (parts, labels) in CLASSES.items():
        here, there = np.isin(seen, list(parts)), np.isin(true, list(labels))
        shown = bool(there.any())
        overlaps[name] = float((here & there).sum() / (here | there).sum()) if shown else None
    return overlaps
