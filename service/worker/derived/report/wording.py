"""What a report says in one language: English is the pattern, others say the same.

Texts with fields in braces are filled by ``str.format``.
"""

import datetime
from collections.abc import Mapping
from dataclasses import dataclass

from api_schemas.derivation_kinds.report import Language
from api_schemas.results import Assumption, FitWarning
from fitter.vocabulary.choices import Gender, ViewKind
from fitter.vocabulary.measurements import Group
from fitter.vocabulary.outcomes import FocalLengthSource, Outcome, Verdict


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """How numbers and dates are written."""

    decimal_sign: str
    date: str
    months: tuple[str, ...]

    def number(self, value: float, form: str) -> str:
        """A number in Python's format, with the language's decimal sign."""
        return format(value, form).replace(".", self.decimal_sign)

    def day(self, date: datetime.date) -> str:
        """A date in words."""
        return self.date.format(day=date.day, month=self.months[date.month - 1], year=date.year)


@dataclass(frozen=True, slots=True, kw_only=True)
class TableWords:
    """The table of measurements, and what stands in its place."""

    number: str
    measurement: str
    value: str
    unit: str
    interval: str
    not_known: str
    given: str
    exact: str
    withheld: str
    figures: Mapping[str, str]
    groups: Mapping[Group, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class LightWords:
    """Light and skin."""

    heading: str
    not_estimated: str
    lamp: str
    from_right: str
    from_left: str
    from_above: str
    from_below: str
    far_away: str
    away: str
    skin: str
    throws_back: str
    gloss: str
    mirrors: str
    all_round: str
    of_lamp: str


@dataclass(frozen=True, slots=True, kw_only=True)
class FitWords:
    """How the fit or the scan went."""

    fit: str
    scan: str
    pictures: str
    how_it_ended: str
    ended: Mapping[Outcome, str]
    outcomes: Mapping[Outcome, str]
    verdicts: Mapping[Verdict, str]
    contradicted: Mapping[Verdict, str]
    """Why, and what to do; the result's own words where there are none."""
    overlap: str
    overlap_of: str
    overlap_in_view: str
    lens: str
    lens_of: str
    lens_sources: Mapping[FocalLengthSource, str]
    picture: str
    pixels: str
    agreement: str
    agreement_of: str
    views: Mapping[ViewKind, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class RemarkWords:
    """What was assumed, and what to look at; findings without words are told as they came."""

    assumed: str
    warned: str
    nothing: str
    quantities: Mapping[str, str]
    values: Mapping[str, str]
    reasons: Mapping[str, str]
    warnings: Mapping[str, str]
    findings: Mapping[str, str]


@dataclass(frozen=True, slots=True, kw_only=True)
class PictureWords:
    """Captions."""

    overlay: str
    sides: Mapping[str, str]
    tapes: str
    tape_sides: Mapping[str, str]
    tapes_note: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Wording:
    """All of a report's words."""

    language: Language
    figures: Figures
    title: str
    scan_title: str
    footnote: str
    genders: Mapping[Gender, str]
    subtitle: str
    scan_subtitle: str
    measurements: Mapping[str, str]
    table: TableWords
    light: LightWords
    fit: FitWords
    remarks: RemarkWords
    pictures: PictureWords


def measurement_name(name: str, wording: Wording) -> str:
    """What a measurement is called; one that has no name here keeps its own."""
    return wording.measurements.get(name) or words(name).capitalize()


def quantity_name(quantity: str, wording: Wording) -> str:
    """What an assumed quantity is called."""
    return wording.remarks.quantities.get(quantity) or words(quantity).capitalize()


def value_in_words(value: str, wording: Wording) -> str:
    """An assumed value that is no number: one name, or several with commas between."""
    names = wording.remarks.values
    return ", ".join(names.get(each) or words(each) for each in value.split(", "))


def reason_in_words(assumption: Assumption, wording: Wording) -> str:
    """Why something was assumed."""
    return wording.remarks.reasons.get(assumption.quantity) or words(assumption.reason)


def warning_in_words(warning: FitWarning, wording: Wording) -> str:
    """What to look at; the service's own words speak of fields of requests in some places."""
    return wording.remarks.warnings.get(warning.code) or words(warning.message)


def words(name: str) -> str:
    """A name as people read it."""
    return name.replace("_", " ")
