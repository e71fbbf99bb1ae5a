"""From where a picture shows a person."""

from enum import StrEnum


class ViewKind(StrEnum):
    """From where a person is seen; ``side`` is either side, ``other`` anything else."""

    FRONT = "front"
    SIDE = "side"
    BACK = "back"
    OTHER = "other"
