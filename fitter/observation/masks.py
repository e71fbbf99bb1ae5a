"""The caller's mask, which replaces GrabCut (section 3.2)."""

import numpy as np

from fitter.arrays import Mask
from fitter.errors import InvalidInputError
from fitter.observation.decoding import decode_coverage
from fitter.observation.resampling import WorkingSize, working_coverage


def decode_mask(
    data: bytes, *, width: int, height: int, size: WorkingSize, max_pixels: int
) -> Mask:
    """The foreground at the working size: pixels more than half of which are white.

    Parameters
    ----------
    width, height
        Size of the upright picture, which the mask must have.

    Raises
    ------
    InvalidInputError
        ``mask-size``, ``mask-without-foreground``, ``mask-without-background``, or as
        :func:`~fitter.observation.decoding.decode_picture` with ``mask-`` for ``image-``.
    """
    coverage = decode_coverage(data, field="mask", max_pixels=max_pixels)
    if coverage.shape != (height, width):
        raise InvalidInputError(
            code="mask-size",
            field="mask",
            reason=(
                f"The mask measures {coverage.shape[1]} x {coverage.shape[0]} pixels, the upright "
                f"picture {width} x {height}."
            ),
            remedy="Send a mask of the picture's size as a browser shows it.",
        )
    mask = working_coverage(np.ascontiguousarray(coverage), size) > 0.5
    if not mask.any():
        raise InvalidInputError(
            code="mask-without-foreground",
            field="mask",
            reason="The mask marks no pixel as the person.",
            remedy="Paint the person white and the rest black.",
        )
    if mask.all():
        raise InvalidInputError(
            code="mask-without-background",
            field="mask",
            reason="The mask marks the whole picture as the person.",
            remedy="Paint the person white and the rest black, or leave the mask out.",
        )
    return mask
