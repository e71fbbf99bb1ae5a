"""Rows and columns of a picture that hold all there is to see."""

import numpy as np
from jaxtyping import Bool, UInt8


def window_about(
    marked: Bool[np.ndarray, "h w"] | UInt8[np.ndarray, "h w"], *, margin: int
) -> tuple[slice, slice]:
    """The rectangle of what is marked, at least one pixel, and ``margin`` pixels around it."""
    rows, columns = np.flatnonzero(marked.any(axis=1)), np.flatnonzero(marked.any(axis=0))
    return (
        slice(max(0, int(rows[0]) - margin), int(rows[-1]) + 1 + margin),
        slice(max(0, int(columns[0]) - margin), int(columns[-1]) + 1 + margin),
    )
