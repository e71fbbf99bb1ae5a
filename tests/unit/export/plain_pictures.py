"""Pictures made smaller by plain means."""

import numpy as np
from jaxtyping import Float

from fitter.arrays import GreyImage


def block_means(picture: GreyImage, factor: int) -> Float[np.ndarray, "h//{factor} w//{factor}"]:
    """Mean over ``factor`` x ``factor`` blocks: from a supersampled picture to an anti-aliased."""
    shifts = [(row, column) for row in range(factor) for column in range(factor)]
    total = sum(picture[row::factor, column::factor] for row, column in shifts)
    return np.asarray(total) / factor**2
