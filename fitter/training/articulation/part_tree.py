"""The 17 rigid parts and how they hang together."""

import numpy as np

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
