"""Covering of a person's regions, as a picture shows it."""

from dataclasses import dataclass

from fitter.vocabulary.choices import BodyRegion, Covering


@dataclass(frozen=True, slots=True, kw_only=True)
class WornRegion:
    """Most probable covering of a region.

    Attributes
    ----------
    probability
        Of ``kind``, in [0, 1].
    ease_m, ease_standard_error_m
        How far clothes stand off the body there on average, metres; None where they do not, or
        where the outline was not found on lines.
    """

    region: BodyRegion
    kind: Covering
    probability: float
    ease_m: float | None = None
    ease_standard_error_m: float | None = None
