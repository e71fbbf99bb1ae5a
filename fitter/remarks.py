"""Assumptions for want of a word from the caller, and warnings of what to look at."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class Assumption:
    """A physical quantity the caller did not give."""

    quantity: str
    value: float | str
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class FitWarning:
    """Something the caller should look at; ``code`` is stable kebab-case."""

    code: str
    message: str
