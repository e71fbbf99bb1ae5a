"""The body in six regions, for figures that tell head, hands and feet from what is measured."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Bool

from fitter.body.model import BodyModel

REGIONS: Mapping[str, tuple[str, ...]] = {
    "trunk": ("pelvis", "spine", "chest", "neck"),
    "arms": ("left_upper_arm", "left_forearm", "right_upper_arm", "right_forearm"),
    "legs": ("left_thigh", "left_shin", "right_thigh", "right_shin"),
    "head": ("head",),
    "hands": ("left_hand", "right_hand"),
    "feet": ("left_foot", "right_foot"),
}


def vertex_regions(model: BodyModel) -> dict[str, Bool[np.ndarray, " m"]]:
    """The vertices of each region: those that follow one of its parts most."""
    return {name: np.isin(model.skinning_parts[:, 0], _ids(model, name)) for name in REGIONS}


def triangle_regions(model: BodyModel) -> dict[str, Bool[np.ndarray, " f"]]:
    """The triangles of each region."""
    return {name: np.isin(model.part_of_triangle, _ids(model, name)) for name in REGIONS}


def _ids(model: BodyModel, region: str) -> list[int]:
    return [model.part_names.index(part) for part in REGIONS[region]]
