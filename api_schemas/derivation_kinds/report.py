"""A page for people: what is asked for, and what comes of it."""

import datetime
from enum import StrEnum
from typing import Literal

from pydantic import Field

from api_schemas.derivation_kinds.base import DerivationOptions, DerivedFiles
from api_schemas.labels import READABLE, ReadableText


class Units(StrEnum):
    """Of lengths and weights: centimetres and kilograms, or inches and pounds."""

    METRIC = "metric"
    IMPERIAL = "imperial"


class Language(StrEnum):
    """Of all that a report says."""

    ENGLISH = "en"
    GERMAN = "de"


class ReportOptions(DerivationOptions):
    """One page for people, as HTML and as PDF."""

    kind: Literal["report"]
    units: Units = Units.METRIC
    language: Language = Field(
        default=Language.ENGLISH,
        description="Of words, numbers and dates; what somebody typed stays as it is.",
    )
    name: ReadableText | None = Field(
        default=None,
        min_length=1,
        max_length=80,
        description=(f"Whose body it is, for the heading; it is kept with the report. {READABLE}"),
    )
    date: datetime.date | None = Field(
        default=None, description="Of the report, for the heading.", examples=["2026-11-23"]
    )


class ReportResult(DerivedFiles):
    """``report.html`` and ``report.pdf``, the same page; both stand alone."""

    kind: Literal["report"] = "report"
