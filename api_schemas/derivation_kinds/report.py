"""A page for people: what is asked for, and what comes of it."""

from typing import Literal

from api_schemas.derivation_kinds.base import DerivationOptions, DerivedFiles


class ReportOptions(DerivationOptions):
    """One page for people, as HTML and as PDF."""

    kind: Literal["report"]


class ReportResult(DerivedFiles):
    """``report.html`` and ``report.pdf``, the same page; both stand alone."""

    kind: Literal["report"] = "report"
