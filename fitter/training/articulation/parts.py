"""The 17 rigid parts: how they hang together, and the mesh cut into them."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer

from fitter.arrays import Triangles
from fitter.body.model import BodyModel

_TREE = (
    ("pelvis", None),
    ("spine", "pelvis"),
    ("chest", "spine"),
    ("neck", "chest"),
    ("head", "neck"),
    ("left_upper_arm", "chest"),
    ("left_forearm", "left_upper_arm"),
    ("left_hand", "left_forearm"),
    ("right_upper_arm", "chest"),
    ("right_forearm", "right_upper_arm"),
    ("right_hand", "right_forearm"),
    ("left_thigh", "pelvis"),
    ("left_shin", "left_thigh"),
    ("left_foot", "left_shin"),
    ("right_thigh", "pelvis"),
    ("right_shin", "right_thigh"),
    ("right_foot", "right_shin"),
)

PART_NAMES = tuple(name for name, _ in _TREE)

PART_PARENT = np.array(
    [-1 if parent is None else PART_NAMES.index(parent) for _, parent in _TREE], dtype=np.int32
)


def part_index(name: str) -> int:
    """Index of a part."""
    return PART_NAMES.index(name)


def side_and_limb(name: str) -> tuple[str, str]:
    """A part's side, ``left``, ``right`` or empty, and its name without it."""
    for side in ("left", "right"):
        if name.startswith(f"{side}_"):
            return side, name.removeprefix(f"{side}_")
    return "", name


def mirrored_part(name: str) -> str:
    """Name of the part on the other side of the body; itself for the parts in the middle."""
    side, limb = side_and_limb(name)
    return f"{'right' if side == 'left' else 'left'}_{limb}" if side else name


FOLLOWED_PARTS = 4
"""Parts whose motion a vertex may follow in the linear-blend tangent."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Parts:
    """The mesh cut into parts; fields as in :class:`fitter.body.model.BodyModel`."""

    part_of_triangle: Integer[np.ndarray, " f"]
    skinning_parts: Integer[np.ndarray, "m 4"]
    skinning_weights: Float[np.ndarray, "m 4"]
    incidence_pointers: Integer[np.ndarray, " p1"]
    incidence_vertices: Integer[np.ndarray, " i"]


def parts_of(model: BodyModel) -> Parts:
    """The parts of a model."""
    return Parts(
        part_of_triangle=model.part_of_triangle,
        skinning_parts=model.skinning_parts,
        skinning_weights=model.skinning_weights,
        incidence_pointers=model.incidence_pointers,
        incidence_vertices=model.incidence_vertices,
    )


def cut_into_parts(triangles: Triangles, weights: Float[np.ndarray, "m p"]) -> Parts:
    """Give each triangle to the part that its corners follow most.

    Parameters
    ----------
    triangles
        (f, 3).
    weights
        Skinning weights summed over the bones of each part, rows sum to one.
    """
    return joined_parts(triangles, np.argmax(weights[triangles].sum(axis=1), axis=1), weights)


def joined_parts(
    triangles: Triangles,
    part_of_triangle: Integer[np.ndarray, " f"],
    weights: Float[np.ndarray, "m p"],
) -> Parts:
    """The same where each triangle's part is given."""
    strongest = np.argsort(-weights, axis=1, kind="stable")[:, :FOLLOWED_PARTS]
    kept = np.take_along_axis(weights, strongest, axis=1)
    touched = [np.unique(triangles[part_of_triangle == part]) for part in range(weights.shape[1])]
    return Parts(
        part_of_triangle=part_of_triangle.astype(np.int32),
        skinning_parts=strongest.astype(np.int32),
        skinning_weights=kept / kept.sum(axis=1, keepdims=True),
        incidence_pointers=np.cumsum([0, *map(len, touched)]).astype(np.int32),
        incidence_vertices=np.concatenate(touched).astype(np.int32),
    )
