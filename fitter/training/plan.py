"""How much of what a model is trained on."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """Counts and seed of one training.

    Subjects are numbered from the seed. The first ``held_out`` are for the report and never
    trained on; the next ``subjects`` are the training set. ``examples`` posed bodies teach the
    pose-dependent term.
    """

    subjects: int
    held_out: int
    examples: int
    seed: int
