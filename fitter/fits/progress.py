"""How a running fit reports what it is doing."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from enum import StrEnum


class Stage(StrEnum):
    """The stages of a fit, in order."""

    OBSERVATION = "observation"
    INITIAL_POSE = "initial_pose"
    SEGMENTATION = "segmentation"
    SILHOUETTE_AND_EDGES = "silhouette_and_edges"
    SHADING = "shading"
    MEASUREMENT = "measurement"
    EXPORT = "export"


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """One report.

    ``fraction`` is the share of the whole fit done so far, in [0, 1], never decreasing; ``view``
    which of several pictures is searched by itself, None where all are searched together and where
    there is one; ``energies`` are the named terms at the moment, empty before there are any.
    """

    stage: Stage
    fraction: float
    view: int | None = None
    energies: Mapping[str, float] = field(default_factory=dict[str, float])


Observer = Callable[[Progress], None]


def ignore_progress(_: Progress) -> None:
    """Observe nothing."""
