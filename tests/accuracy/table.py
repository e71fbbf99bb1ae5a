"""The figures of fits as text: one line a fit, sums, and one printer of errors for all tables."""

from collections.abc import Callable, Mapping, Sequence
from typing import Protocol

import numpy as np

from fitter.vocabulary.choices import Cues
from tests.accuracy.scoring import Scored

Measurement = tuple[str, str, str]
"""Title, name and unit."""

MEASUREMENTS: Sequence[Measurement] = (
    ("chest", "chest_girth", "cm"),
    ("waist", "waist_girth_smallest", "cm"),
    ("hip", "hip_girth", "cm"),
    ("weight", "weight", "kg"),
    ("navel", "waist_girth_navel", "cm"),
)
"""The level-free waist is the smallest; the navel's level is a matter of definition."""

INTERVALS = ((68, 1.0), (95, 1.96))
"""Per cent of a normal distribution within so many standard errors."""

BMI_CLASSES: Mapping[str, tuple[float, float]] = {
    "< 18.5": (0.0, 18.5),
    "18.5-25": (18.5, 25.0),
    "25-30": (25.0, 30.0),
    "30-35": (30.0, 35.0),
    ">= 35": (35.0, np.inf),
}
"""Lower bounds count, upper ones do not, as the WHO draws them (kilograms per square metre)."""

TITLE = 40

Figure = Callable[[Scored], float | None]


class Erring(Protocol):
    """What a fit errs by: measured minus true, and the standard errors that it states."""

    @property
    def person(self) -> str: ...
    @property
    def errors(self) -> Mapping[str, float]: ...
    @property
    def standard_errors(self) -> Mapping[str, float]: ...


def error_heading(title: str, measurements: Sequence[Measurement] = MEASUREMENTS) -> str:
    """The heading above :func:`error_line`."""
    columns = "".join(f"{f'{name} {unit}':>21s}{'width':>6s}" for name, _, unit in measurements)
    return f"{title:{TITLE}s}{'n':>4s}{columns}{f'{INTERVALS[-1][0]} % hold':>11s}"


def error_line(
    title: str,
    these: Sequence[Erring],
    *,
    places: int,
    measurements: Sequence[Measurement] = MEASUREMENTS,
) -> str:
    """Mean absolute errors with their standard errors over people, in brackets their mean.

    Beside each the median width of the 95 % interval, end to end; then the share of truths in these
    intervals, of what was not given.
    """
    deviations = INTERVALS[-1][1]
    line = f"{title:{TITLE}s}{len(these):4d}"
    for _, key, _ in measurements:
        line += f"{_cell(these, key, places):>21s}"
        known = [each.standard_errors[key] for each in these if key in each.standard_errors]
        line += f"{2.0 * deviations * np.median(known):6.1f}" if known else f"{'-':>6s}"
    keys = [key for _, key, _ in measurements]
    by_fit = [held(each, keys, deviations) for each in these]
    yes = [each for several in by_fit for each in several]
    shares = np.array([100.0 * np.mean(each) for each in by_fit if each])
    people = [each.person for each, own in zip(these, by_fit, strict=True) if own]
    share = f"{100.0 * np.mean(yes):.0f}{spread(people, shares, 0)} %" if yes else "-"
    return f"{line}{share:>11s}"


def _cell(these: Sequence[Erring], key: str, places: int) -> str:
    if not these:
        return "-"
    errors = np.array([each.errors[key] for each in these])
    uncertain = spread([each.person for each in these], np.abs(errors), places)
    return f"{np.abs(errors).mean():.{places}f}{uncertain} ({errors.mean():+.{places}f})"


def spread(people: Sequence[str], values: Sequence[float] | np.ndarray, places: int) -> str:
    """The standard error of a mean over people, who are independent; nothing of one of them."""
    of = np.array(people)
    means = [np.asarray(values)[of == person].mean() for person in dict.fromkeys(people)]
    if len(means) < 2:
        return ""
    return f" ±{np.std(means, ddof=1) / len(means) ** 0.5:.{places}f}"


def bmi_class(bmi: float) -> str:
    """The name of a body mass index's class."""
    return next(name for name, (low, high) in BMI_CLASSES.items() if low <= bmi < high)


def bmi_lines(scored: Sequence[Scored]) -> list[str]:
    """Errors by class of body mass index."""
    lines = [error_heading("BMI")]
    for name in BMI_CLASSES:
        for cues in Cues:
            these = [each for each in scored if each.cues is cues and bmi_class(each.bmi) == name]
            if these:
                lines.append(error_line(f"{name:10s}{cues.value}", these, places=2))
    return lines


def case_lines(scored: Sequence[Scored]) -> list[str]:
    """One line a fit: signed errors."""
    heading = f"{'case':45s}{'cues':5s}" + "".join(
        f"{f'{name} {unit}':>10s}" for name, _, unit in MEASUREMENTS
    )
    heading += (
        f"{'vertex mm':>11s}{'joint mm':>10s}{'overlap':>9s}{'mask':>7s}{'light°':>8s}{'s':>6s}"
    )
    return [heading, *(_case_line(each) for each in scored)]


def summary_lines(scored: Sequence[Scored]) -> list[str]:
    """Of each kind of fit: mean absolute, bias, median and 95th percentile of absolute errors, and
    the median width of the 95 % interval; then shares."""
    lines = [
        f"{'':18s}"
        + "".join(
            f"{f'{cues} mean':>11s}{'bias':>8s}{'median':>8s}{'p95':>8s}{'width':>8s}"
            for cues in Cues
        )
    ]
    for name, key, unit in MEASUREMENTS:
        lines.append(
            _figure_line(
                f"{name} [{unit}]",
                scored,
                lambda each, key=key: each.errors[key],
                width=lambda each, key=key: _width(each, key),
            )
        )
    for name, figure in _unsigned_figures():
        lines.append(_figure_line(name, scored, figure))
    lines += [
        f"{name:18s}" + "".join(f"{_share(values[cues]):>11s}{'':32s}" for cues in Cues).rstrip()
        for name, values in _shares(scored)
    ]
    return [*lines, *_outcome_lines(scored), *cue_lines(scored)]


def cue_lines(scored: Sequence[Scored]) -> list[str]:
    """Pictures whose error is smaller by SES than by SE, and how mean absolute errors differ.

    With the standard error of that difference over people, who are independent.
    """
    fits = {(each.name, each.cues): each for each in scored}
    pairs = [
        (se, fits[name, Cues.SES])
        for (name, cues), se in fits.items()
        if cues is Cues.SE and (name, Cues.SES) in fits
    ]
    if not pairs:
        return []
    people = [each.person for each, _ in pairs]
    lines = [f"{'SES against SE':18s}{'nearer':>11s}{'SES - SE':>10s}{'':>8s}"]
    for name, key, unit in MEASUREMENTS:
        se, ses = np.abs([[each.errors[key] for each in pair] for pair in pairs]).T
        change = float(np.mean(ses - se))
        worse = "  worse" if change > 0.0 else ""
        share, uncertain = _share(list(ses < se)), spread(people, ses - se, 2).strip()
        lines.append(f"{f'  {name} [{unit}]':18s}{share:>11s}{change:+10.2f}{uncertain:>8s}{worse}")
    return lines


def worst_lines(scored: Sequence[Scored], count: int = 5) -> list[str]:
    """The fits by SES whose girths are farthest from the truth on the mean."""
    girths = [key for _, key, unit in MEASUREMENTS if unit == "cm"]

    def distance(each: Scored) -> float:
        return float(np.mean([abs(each.errors[key]) for key in girths]))

    shaded = sorted((each for each in scored if each.cues is Cues.SES), key=distance)
    return ["worst", *(_case_line(each) for each in shaded[::-1][:count])] if shaded else []


def held(scored: Erring, keys: Sequence[str], deviations: float) -> list[bool]:
    """Whether intervals of so many standard errors hold the true measurements."""
    return [
        abs(scored.errors[key]) <= deviations * scored.standard_errors[key]
        for key in keys
        if key in scored.standard_errors
    ]


def _unsigned_figures() -> list[tuple[str, Figure]]:
    return [
        ("vertices [mm]", lambda each: each.vertex_mm),
        ("joints [mm]", lambda each: each.joint_mm),
        ("1 - overlap [%]", lambda each: 100.0 * (1.0 - each.overlap)),
        ("light [degrees]", lambda each: each.light_degrees),
        ("seconds", lambda each: each.seconds),
    ]


def _figure_line(
    name: str, scored: Sequence[Scored], figure: Figure, *, width: Figure | None = None
) -> str:
    """A signed figure has a bias and a width, an unsigned one has neither."""
    line = f"{name:18s}"
    for cues in Cues:
        fits = [each for each in scored if each.cues is cues]
        values = np.array([value for each in fits if (value := figure(each)) is not None])
        if not len(values):
            line += f"{'-':>11s}" + 4 * f"{'-':>8s}"
            continue
        away, bias, median_width = np.abs(values), "-", "-"
        if width is not None:
            widths = [value for each in fits if (value := width(each)) is not None]
            bias = f"{values.mean():+.2f}"
            median_width = f"{np.median(widths):.2f}" if widths else "-"
        line += f"{away.mean():11.2f}{bias:>8s}{np.median(away):8.2f}"
        line += f"{np.percentile(away, 95):8.2f}{median_width:>8s}"
    return line


def _width(scored: Scored, key: str) -> float | None:
    """Of the 95 % interval, from end to end."""
    if key not in scored.standard_errors:
        return None
    return 2.0 * INTERVALS[-1][1] * scored.standard_errors[key]


def _shares(scored: Sequence[Scored]) -> list[tuple[str, dict[Cues, list[bool]]]]:
    """Yes or no of every fit: whether intervals hold the truth, whether the pose failed."""
    of = {cues: [each for each in scored if each.cues is cues] for cues in Cues}
    keys = [key for _, key, _ in MEASUREMENTS]
    rows = [
        (
            f"truth in {level} %",
            {cues: [yes for each in of[cues] for yes in held(each, keys, z)] for cues in Cues},
        )
        for level, z in INTERVALS
    ]
    rows += [
        (
            f"  {name} in {level} %",
            {cues: [yes for each in of[cues] for yes in held(each, [key], z)] for cues in Cues},
        )
        for name, key, _ in MEASUREMENTS
        for level, z in INTERVALS
    ]
    rows.append(("failures", {cues: [each.failed for each in of[cues]] for cues in Cues}))
    return rows


def _outcome_lines(scored: Sequence[Scored]) -> list[str]:
    """How fits say they ended, one line an outcome."""
    return [
        f"{f'  {outcome}':18s}"
        + "".join(
            f"{_share([each.outcome == outcome for each in scored if each.cues is cues]):>11s}"
            f"{'':32s}"
            for cues in Cues
        ).rstrip()
        for outcome in sorted({each.outcome for each in scored})
    ]


def _share(yes: Sequence[bool]) -> str:
    return f"{sum(yes)}/{len(yes)} {np.mean(yes):4.0%}" if yes else "-"


def _case_line(scored: Scored) -> str:
    line = f"{scored.name:45s}{scored.cues.value:5s}"
    line += "".join(f"{scored.errors[key]:+10.1f}" for _, key, _ in MEASUREMENTS)
    vertex = "-" if scored.vertex_mm is None else f"{scored.vertex_mm:.1f}"
    line += f"{vertex:>11s}{scored.joint_mm:10.1f}"
    line += f"{scored.overlap:9.3f}{scored.mask_overlap:7.3f}"
    light = "-" if scored.light_degrees is None else f"{scored.light_degrees:.1f}"
    failed = " failed " + " ".join(scored.wrong_limbs) if scored.failed else ""
    return f"{line}{light:>8s}{scored.seconds:6.1f}{failed}".rstrip()
