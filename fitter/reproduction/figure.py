"""What a figure of the paper becomes here: a picture, and words about it."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import UInt8


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Figure:
    """One of the paper's figures, drawn anew.

    Attributes
    ----------
    name
        ``figure_2``: of its file.
    title
        Its number in the paper, and what it is about.
    caption
        What is to be seen.
    differs
        What is not as in the paper's.
    picture
        (h, w, 3) sRGB levels.
    """

    name: str
    title: str
    caption: str
    differs: str
    picture: UInt8[np.ndarray, "h w 3"]
