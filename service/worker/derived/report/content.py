"""What the report says, in words: the numbers, units and names of ``result.json``."""

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Final

from api_schemas.requests import Cues
from api_schemas.results import (
    Assumption,
    CameraResult,
    FitResult,
    FitWarning,
    FocalLengthSource,
    LightResult,
    Measurement,
    ReflectanceResult,
    SurroundingsResult,
    Verdict,
)
from fitter.measurement.groups import CHIEF, Group, group_of

WITHIN_95: Final = 1.96
"""Standard errors on either side of a value that make a 95 % interval."""

DIAGONAL_35MM: Final = 43.27
"""Diagonal of the 24 x 36 mm frame, to which the 35 mm equivalent of a focal length refers."""

TITLE: Final = "Body, pose and light from one picture"

FOOTNOTE: Final = (
    "Measured in the canonical pose, right limbs; every definition and its source is in "
    "result.json. Intervals are 1.96 standard errors of the fit on either side. This is no medical "
    "device."
)

WITHHELD: Final = (
    "Measurements are withheld, because the picture contradicts a person: see the outcome."
)

CUES: Final = {
    Cues.SE: "silhouette and edges (SE)",
    Cues.SES: "silhouette, edges and shading (SES)",
}
_LENS: Final = {
    FocalLengthSource.CALLER: "given",
    FocalLengthSource.EXIF_35MM: "from the picture's EXIF data",
    FocalLengthSource.EXIF_SENSOR: "from the picture's EXIF data",
    FocalLengthSource.ASSUMED: "assumed",
}


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasurementRow:
    """A measurement as printed; ``interval`` may say that the value was given."""

    name: str
    value: str
    unit: str
    interval: str


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasurementGroup:
    """Measurements of one kind under their heading."""

    heading: str
    rows: tuple[MeasurementRow, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A heading with facts, each a label and a text, and remarks."""

    heading: str
    facts: tuple[tuple[str, str], ...] = ()
    remarks: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ReportContent:
    """The page without its pictures; plain text throughout.

    Without measurements :data:`WITHHELD` stands in their place. ``measurements`` are the chief
    ones, ``further`` all others.
    """

    title: str
    subtitle: str
    measurements: tuple[MeasurementRow, ...]
    further: tuple[MeasurementGroup, ...]
    sections: tuple[Section, ...]


def report_content(result: FitResult) -> ReportContent:
    """Put a result into words."""
    return ReportContent(
        title=TITLE,
        subtitle=f"{result.gender.capitalize()}, {result.height_m:.3f} m, by {CUES[result.cues]}",
        measurements=chief_rows(result.measurements),
        further=further_groups(result.measurements),
        sections=(
            _light_and_skin(result.light, result.reflectance),
            _fit(result),
            assumed(result.assumptions),
            warned(result.warnings),
        ),
    )


def chief_rows(measurements: Sequence[Measurement]) -> tuple[MeasurementRow, ...]:
    """The chief ones, in words."""
    return tuple(measurement_row(each) for each in measurements if each.name in CHIEF)


def further_groups(measurements: Sequence[Measurement]) -> tuple[MeasurementGroup, ...]:
    """All others, by groups."""
    others = [each for each in measurements if each.name not in CHIEF]
    groups = {
        group: tuple(measurement_row(each) for each in others if group_of(each.name) is group)
        for group in Group
    }
    return tuple(
        MeasurementGroup(heading=group.value, rows=rows) for group, rows in groups.items() if rows
    )


def measurement_row(measurement: Measurement) -> MeasurementRow:
    """Put a measurement into words."""
    value, error = measurement.value, measurement.standard_error
    if error is None:
        interval = "not known"
    elif error == 0.0:
        interval = "given" if measurement.given else "exact"
    else:
        low, high = value - WITHIN_95 * error, value + WITHIN_95 * error
        interval = f"{low:.1f} – {high:.1f}"
    return MeasurementRow(
        name=words(measurement.name),
        value=f"{value:.1f}",
        unit=measurement.unit,
        interval=interval,
    )


def _light_and_skin(light: LightResult | None, reflectance: ReflectanceResult | None) -> Section:
    heading = "Light and reflectance"
    if light is None or reflectance is None:
        return Section(
            heading=heading,
            remarks=("Not estimated: the fit was made by silhouette and edges alone.",),
        )
    across = (
        f"{abs(light.azimuth_deg):.0f}° from the {'right' if light.azimuth_deg > 0 else 'left'}"
    )
    along = (
        f"{abs(light.elevation_deg):.0f}° from {'above' if light.elevation_deg > 0 else 'below'}"
    )
    away = "far away" if light.distance_m is None else f"{light.distance_m:.2f} m away"
    return Section(
        heading=heading,
        facts=(
            (f"{words(light.kind).capitalize()} light", f"{across}, {along}, {away}"),
            ("Mean albedo", f"{reflectance.mean_albedo:.3f}"),
            ("Mean specularity", f"{reflectance.mean_specularity:.3f}"),
            ("Specular exponent", f"{reflectance.specular_exponent:.0f}"),
            ("Ambient", f"{reflectance.ambient:.3f}")
            if light.surroundings is None
            else ("Light from all round", _surroundings(light.surroundings)),
        ),
    )


def _surroundings(surroundings: SurroundingsResult) -> str:
    """The mean of E over all directions."""
    mean = surroundings.coefficients[0] / (2.0 * math.sqrt(math.pi))
    return f"{100.0 * mean:.0f} % of the lamp's on the mean"


def _fit(result: FitResult) -> Section:
    return Section(
        heading="The fit",
        facts=(
            ("Outcome", f"{_ended(result)}. {result.outcome_explanation}"),
            ("Overlap with the silhouette", f"{100.0 * result.silhouette_overlap:.1f} %"),
            ("Focal length", lens(result.image_camera, result.focal_length_source)),
            ("Picture", f"{result.image_camera.width} × {result.image_camera.height} pixels"),
        ),
    )


def _ended(result: FitResult) -> str:
    return words(result.outcome if result.verdict is Verdict.PLAUSIBLE else result.verdict)


def lens(camera: CameraResult, source: FocalLengthSource) -> str:
    """The focal length, and who says so."""
    equivalent_mm = camera.focal_length_px * DIAGONAL_35MM / math.hypot(camera.width, camera.height)
    return f"{camera.focal_length_px:.0f} px ({equivalent_mm:.0f} mm equivalent), {_LENS[source]}"


def assumed(assumptions: Collection[Assumption]) -> Section:
    """What was assumed, and why."""
    heading = "What was assumed"
    if not assumptions:
        return Section(heading=heading, remarks=("Nothing.",))
    return Section(
        heading=heading,
        facts=tuple(
            (words(each.quantity).capitalize(), f"{_assumed_value(each)}. {each.reason}")
            for each in assumptions
        ),
    )


def warned(warnings: Iterable[FitWarning]) -> Section:
    """What to look at."""
    remarks = tuple(each.message for each in warnings)
    return Section(heading="Warnings", remarks=remarks or ("None.",))


def _assumed_value(assumption: Assumption) -> str:
    value = assumption.value
    return value if isinstance(value, str) else f"{value:.4g}"


def words(name: str) -> str:
    """A name as people read it."""
    return name.replace("_", " ")
