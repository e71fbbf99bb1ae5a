"""The paper's own method beside this package's, on the same pictures.

A fit with shading says what the outline alone said too, in its stage SE.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from fitter.fits.pipeline import fit
from fitter.request import Paper
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues
from tests.accuracy.runs import picture_of
from tests.accuracy.table import MEASUREMENTS, error_heading, error_line, spread
from tests.one_picture import changed

METHODS: Mapping[str, Paper | None] = {"the paper's method": Paper(), "this package's method": None}


@dataclass(frozen=True, slots=True, kw_only=True)
class MethodError:
    """Found minus true, by measurement, of one picture by one method and some cues."""

    method: str
    cues: Cues
    person: str
    errors: Mapping[str, float]
    standard_errors: Mapping[str, float] = field(default_factory=dict[str, float])


def method_errors(name: str) -> list[MethodError]:
    """Fit one picture by either method."""
    picture = picture_of(name)
    request = changed(picture.request, cues=Cues.SES, force=True)
    found: list[MethodError] = []
    for method, paper in METHODS.items():
        result = fit(replace(request, choices=replace(request.choices, paper=paper)))
        for cues in Cues:
            measured = _measured(result, cues)
            errors = {
                key: measured[key] - picture.truth.measurements[key] for _, key, _ in MEASUREMENTS
            }
            found.append(
                MethodError(method=method, cues=cues, person=picture.person, errors=errors)
            )
    return found


def method_lines(found: Sequence[MethodError]) -> list[str]:
    """Errors of either method; below, by how much this package's errs more than the paper's."""
    lines, of = [error_heading("method")], {}
    for method in METHODS:
        for cues in Cues:
            these = [each for each in found if each.method == method and each.cues is cues]
            of[method, cues] = these
            lines.append(error_line(f"{method:30s}{cues}", these, places=2))
    papers, ours = METHODS
    lines.append("this package's - the paper's")
    for cues in Cues:
        pairs = list(zip(of[ours, cues], of[papers, cues], strict=True))
        people = [each.person for each, _ in pairs]
        line = f"  {cues}"
        for name, key, unit in MEASUREMENTS:
            changes = np.array([abs(a.errors[key]) - abs(b.errors[key]) for a, b in pairs])
            line += f"  {name} {changes.mean():+.2f}{spread(people, changes, 2)} {unit}"
        lines.append(line)
    return lines


def _measured(result: FitResult, cues: Cues) -> dict[str, float]:
    stage = result.stages[-1]
    if cues is Cues.SE:
        stage = next((each for each in result.stages if each.name == "SE"), stage)
    return {each.name: each.value for each in stage.measurements}
