"""What the report says, in words: the numbers, units and names of ``result.json``."""

import math
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final

from api_schemas.derivation_kinds.report import ReportOptions
from api_schemas.results import (
    WITHIN_95,
    Assumption,
    CameraResult,
    Finding,
    FitResult,
    FitWarning,
    LightResult,
    Measurement,
    ReflectanceResult,
)
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.measurements import CHIEF, Group, group_of
from fitter.vocabulary.outcomes import FocalLengthSource, Outcome, Verdict
from service.worker.derived.report.units import height_in_words, in_units
from service.worker.derived.report.wording import (
    Wording,
    measurement_name,
    quantity_name,
    reason_in_words,
    value_in_words,
    warning_in_words,
)
from service.worker.derived.report.wordings import WORDINGS

DIAGONAL_35MM: Final = 43.27
"""Diagonal of the 24 x 36 mm frame, to which the 35 mm equivalent of a focal length refers."""

DEFAULTS: Final = ReportOptions(kind="report")
NO_NUMBERS: Final[Mapping[str, int]] = MappingProxyType({})


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasurementRow:
    """A measurement as printed; ``interval`` may say that the value was given.

    ``number`` is that of its tape in the drawing, None where it has none.
    """

    name: str
    value: str
    unit: str
    interval: str
    number: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasurementGroup:
    """Measurements of one kind under their heading."""

    heading: str
    rows: tuple[MeasurementRow, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A heading with facts, each a label and a text, and remarks.

    What is ``for_experts`` stands after all else.
    """

    heading: str
    facts: tuple[tuple[str, str], ...] = ()
    remarks: tuple[str, ...] = ()
    for_experts: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportContent:
    """The page without its pictures; plain text throughout.

    Without measurements the table's ``withheld`` stands in their place. ``figures`` are those that
    most people ask for and stand first, ``measurements`` the chief ones, ``further`` all others.
    """

    wording: Wording
    title: str
    subtitle: str
    figures: tuple[MeasurementRow, ...]
    measurements: tuple[MeasurementRow, ...]
    further: tuple[MeasurementGroup, ...]
    sections: tuple[Section, ...]


def report_content(
    result: FitResult,
    options: ReportOptions = DEFAULTS,
    *,
    numbers: Mapping[str, int] = NO_NUMBERS,
) -> ReportContent:
    """Put a result into words; ``numbers`` are those of tapes, by the measurements' names."""
    wording = WORDINGS[options.language]
    return ReportContent(
        wording=wording,
        title=wording.title,
        subtitle=wording.subtitle.format(about=about(result.gender, result.height_m, options)),
        figures=figure_rows(result.measurements, options),
        measurements=chief_rows(result.measurements, options, numbers),
        further=further_groups(result.measurements, options),
        sections=(
            _light_and_skin(result.light, result.reflectance, wording),
            _fit(result, wording),
            assumed(result.assumptions, options),
            warned(result.findings, result.warnings, wording),
        ),
    )


def about(gender: Gender, height_m: float, options: ReportOptions) -> str:
    """Whose body it is, of which day, and what the request says of the person."""
    wording = WORDINGS[options.language]
    day = None if options.date is None else wording.figures.day(options.date)
    person = f"{wording.genders[gender]}, {_height(height_m, options)}"
    return ", ".join(part for part in (options.name, day, person) if part)


def chief_rows(
    measurements: Sequence[Measurement], options: ReportOptions, numbers: Mapping[str, int]
) -> tuple[MeasurementRow, ...]:
    """The chief ones, in words."""
    return tuple(
        measurement_row(each, options, number=numbers.get(each.name))
        for each in measurements
        if each.name in CHIEF
    )


def figure_rows(
    measurements: Sequence[Measurement], options: ReportOptions
) -> tuple[MeasurementRow, ...]:
    """Those that most people ask for, by their short names."""
    found = {each.name: each for each in measurements}
    names = WORDINGS[options.language].table.figures
    return tuple(
        replace(measurement_row(found[name], options, number=None), name=short)
        for name, short in names.items()
        if name in found
    )


def further_groups(
    measurements: Sequence[Measurement], options: ReportOptions
) -> tuple[MeasurementGroup, ...]:
    """All others, by groups."""
    others = [each for each in measurements if each.name not in CHIEF]
    groups = {
        group: tuple(
            measurement_row(each, options, number=None)
            for each in others
            if group_of(each.name) is group
        )
        for group in Group
    }
    headings = WORDINGS[options.language].table.groups
    return tuple(
        MeasurementGroup(heading=headings[group], rows=rows)
        for group, rows in groups.items()
        if rows
    )


def measurement_row(
    measurement: Measurement, options: ReportOptions, *, number: int | None
) -> MeasurementRow:
    """Put a measurement into words."""
    wording = WORDINGS[options.language]
    shown = wording.figures.number
    value, unit = in_units(measurement.value, measurement.unit, options.units)
    error = measurement.standard_error
    if error is None:
        interval = wording.table.not_known
    elif error == 0.0:
        interval = wording.table.given if measurement.given else wording.table.exact
    else:
        half, _ = in_units(WITHIN_95 * error, measurement.unit, options.units)
        interval = f"{shown(value - half, '.1f')} – {shown(value + half, '.1f')}"
    return MeasurementRow(
        name=measurement_name(measurement.name, wording),
        value=shown(value, ".1f"),
        unit=unit,
        interval=interval,
        number=number,
    )


def _light_and_skin(
    light: LightResult | None, reflectance: ReflectanceResult | None, wording: Wording
) -> Section:
    said, number = wording.light, wording.figures.number
    if light is None or reflectance is None:
        return Section(heading=said.heading, remarks=(said.not_estimated,), for_experts=True)
    across = (said.from_right if light.azimuth_deg > 0 else said.from_left).format(
        degrees=number(abs(light.azimuth_deg), ".0f")
    )
    along = (said.from_above if light.elevation_deg > 0 else said.from_below).format(
        degrees=number(abs(light.elevation_deg), ".0f")
    )
    away = (
        said.far_away
        if light.distance_m is None
        else said.away.format(metres=number(light.distance_m, ".2f"))
    )
    all_round = said.of_lamp.format(percent=number(100.0 * reflectance.ambient, ".0f"))
    skin = number(100.0 * reflectance.mean_albedo, ".0f")
    gloss = number(100.0 * reflectance.mean_specularity, ".0f")
    return Section(
        heading=said.heading,
        facts=(
            (said.lamp, f"{across}, {along}, {away}"),
            (said.skin, said.throws_back.format(percent=skin)),
            (said.gloss, said.mirrors.format(percent=gloss)),
            (said.all_round, all_round),
        ),
        for_experts=True,
    )


def _fit(result: FitResult, wording: Wording) -> Section:
    said, camera = wording.fit, result.image_camera
    overlap = wording.figures.number(100.0 * result.silhouette_overlap, ".0f")
    ended = how_it_ended(result.verdict, result.outcome, result.outcome_explanation, wording)
    return Section(
        heading=said.fit,
        facts=(
            (said.how_it_ended, ended),
            (said.overlap, said.overlap_of.format(percent=overlap)),
            (said.lens, lens(camera, result.focal_length_source, wording)),
            (said.picture, said.pixels.format(width=camera.width, height=camera.height)),
        ),
    )


def how_it_ended(verdict: Verdict, outcome: Outcome, explanation: str, wording: Wording) -> str:
    """What the outcome means, or why a person is contradicted."""
    said = wording.fit
    if verdict is Verdict.PLAUSIBLE:
        return said.ended[outcome]
    return f"{said.verdicts[verdict]}. {said.contradicted.get(verdict) or explanation}"


def lens(camera: CameraResult, source: FocalLengthSource, wording: Wording) -> str:
    """The focal length as on 35 mm film, and who says so."""
    equivalent_mm = camera.focal_length_px * DIAGONAL_35MM / math.hypot(camera.width, camera.height)
    return wording.fit.lens_of.format(
        millimetres=wording.figures.number(equivalent_mm, ".0f"),
        source=wording.fit.lens_sources[source],
    )


def assumed(assumptions: Collection[Assumption], options: ReportOptions) -> Section:
    """What was assumed, and why."""
    wording = WORDINGS[options.language]
    said = wording.remarks
    if not assumptions:
        return Section(heading=said.assumed, remarks=(said.nothing,))
    return Section(
        heading=said.assumed,
        facts=tuple(
            (
                quantity_name(each.quantity, wording),
                f"{_assumed_value(each, options)}. {reason_in_words(each, wording)}",
            )
            for each in assumptions
        ),
    )


def warned(
    findings: Iterable[Finding], warnings: Iterable[FitWarning], wording: Wording
) -> Section:
    """What to look at: what is wrong with the pictures, and the rest."""
    said = wording.remarks
    remarks = [said.findings.get(each.code) or f"{each.reason} {each.remedy}" for each in findings]
    remarks += [warning_in_words(each, wording) for each in warnings]
    return Section(heading=said.warned, remarks=tuple(remarks) or (said.nothing,))


def _assumed_value(assumption: Assumption, options: ReportOptions) -> str:
    value, wording = assumption.value, WORDINGS[options.language]
    if isinstance(value, str):
        return value_in_words(value, wording)
    if assumption.quantity == "height_m":
        return _height(value, options)
    shown = wording.figures.number(value, ".4g")
    return f"{shown} mm" if assumption.quantity == "focal_length_35mm" else shown


def _height(height_m: float, options: ReportOptions) -> str:
    return height_in_words(height_m, options.units, WORDINGS[options.language].figures)
