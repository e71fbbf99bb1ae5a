"""Measurements as their readers see them."""

from dataclasses import dataclass
from typing import Final

INTERVAL_SD: Final = 1.959964
"""Half of a 95 % interval, in standard errors."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Measurement:
    """One anthropometric measurement in its unit.

    Attributes
    ----------
    name
        A stable snake_case name, e.g. ``waist_girth_navel``.
    value, unit
        The value in ``unit``: ``cm`` or ``kg``.
    standard_error
        The Laplace approximation's standard deviation at the final body, in ``unit``; None where
        it was not computed.
    definition, source
        How it is taken, and by whom it is so defined.
    """

    name: str
    value: float
    unit: str
    standard_error: float | None
    definition: str
    source: str
