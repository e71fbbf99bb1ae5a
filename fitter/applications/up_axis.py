"""Which axis of a motion's file points up: the one along which heads are above feet."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vector3
from fitter.numerics.rotations import unit_vectors
from fitter.remarks import FitWarning

Axis = Literal["y", "-y", "z", "-z", "x", "-x"]
AXES: tuple[Axis, ...] = get_args(Axis)
"""In the order in which they are preferred: most files' up is y."""

_UPRIGHT_COSINE = np.cos(np.radians(45.0))

_MOST = 0.75
"""Of the frames: where fewer are upright along any axis, up is in doubt."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class UpAxis:
    """The axis, its rotation to a world whose y is up, and a warning where it is in doubt."""

    axis: Axis
    to_world: Float[np.ndarray, "3 3"]
    warnings: tuple[FitWarning, ...]


def told_up_axis(axis: Axis) -> UpAxis:
    """The axis that the caller says is up."""
    return UpAxis(axis=axis, to_world=_to_world(axis), warnings=())


def found_up_axis(feet_to_head: Float[np.ndarray, "t 3"]) -> UpAxis:
    """The axis along which the head is above the feet in most of the frames.

    Parameters
    ----------
    feet_to_head
        From the middle of the feet to the head, in the file's axes.
    """
    towards = unit_vectors(feet_to_head)
    heights = np.stack([towards @ _direction(axis) for axis in AXES])
    shares = (heights > _UPRIGHT_COSINE).mean(axis=1)
    # Where no axis has upright frames, the one that is nearest on the whole.
    best = int(np.lexsort((-np.arange(len(AXES)), heights.mean(axis=1), shares))[-1])
    axis, share = AXES[best], float(shares[best])
    warnings: tuple[FitWarning, ...] = ()
    if axis != AXES[0] or share < _MOST:
        message = (
            f"Up was taken to be the file's {axis}: along it the head is above the feet in "
            f"{share:.0%} of the frames. If that is wrong, as for a person who lies, send `up`."
        )
        warnings = (FitWarning(code="up-uncertain", message=message),)
    return UpAxis(axis=axis, to_world=_to_world(axis), warnings=warnings)


def _direction(axis: str) -> Vector3:
    return np.eye(3)["xyz".index(axis[-1])] * (-1.0 if axis.startswith("-") else 1.0)


def _to_world(axis: str) -> Float[np.ndarray, "3 3"]:
    up = _direction(axis)
    first = np.roll(np.abs(up), -1)
    return np.stack([first, up, np.cross(first, up)])
