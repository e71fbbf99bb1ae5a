"""The suite's figures as text: signed errors of each fit, and their summary."""

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Float

from fitter.vocabulary.choices import Cues
from tests.accuracy.scoring import Scored

MEASUREMENTS = (
    ("chest", "chest_girth", "cm"),
    ("waist", "waist_girth_smallest", "cm"),
    ("hip", "hip_girth", "cm"),
    ("weight", "weight", "kg"),
    ("navel", "waist_girth_navel", "cm"),
)
"""The level-free waist is the smallest; the navel's level is a matter of definition."""

INTERVALS = ((68, 1.0), (95, 1.96))
"""Per cent of a normal distribution within so many standard errors."""

Figure = Callable[[Scored], float | None]


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
        share, uncertain = _share(list(ses < se)), _standard_error(people, ses - se)
        lines.append(f"{f'  {name} [{unit}]':18s}{share:>11s}{change:+10.2f}{uncertain:>8s}{worse}")
    return lines


def _standard_error(people: Sequence[str], changes: Float[np.ndarray, " k"]) -> str:
    """Of the mean over people, each with the mean over their pictures."""
    means = [changes[np.array(people) == person].mean() for person in dict.fromkeys(people)]
    return f"±{np.std(means, ddof=1) / len(means) ** 0.5:.2f}" if len(means) > 1 else ""


def worst_lines(scored: Sequence[Scored], count: int = 5) -> list[str]:
    """The fits by SES whose girths are farthest from the truth on the mean."""
    girths = [key for _, key, unit in MEASUREMENTS if unit == "cm"]

    def distance(each: Scored) -> float:
        return float(np.mean([abs(each.errors[key]) for key in girths]))

    shaded = sorted((each for each in scored if each.cues is Cues.SES), key=distance)
    return ["worst", *(_case_line(each) for each in shaded[::-1][:count])] if shaded else []


def held(scored: Scored, keys: Sequence[str], deviations: float) -> list[bool]:
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
