"""The paper's own method beside this package's, on the same pictures; and what additions are worth.

A fit with shading says what the outline alone said too, in its stage SE.
"""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from unittest import mock

import numpy as np

from fitter.energies.objective import JointObjective
from fitter.energies.shape_terms import population_prior
from fitter.fits import paper
from fitter.fits.pipeline import fit
from fitter.request import Paper
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues
from tests.accuracy.runs import picture_of
from tests.accuracy.table import MEASUREMENTS
from tests.one_picture import changed

PAPER, OURS = "the paper's method", "this package's method"
SHAPE, POSE = "with the prior on shape", "with clicks and priors on pose"
METHODS = (PAPER, f"  {SHAPE}", f"  {POSE}", "  with both", OURS)

ADDED_TERMS = frozenset({"clicks", "pose_prior", "stance"})


@dataclass(frozen=True, slots=True, kw_only=True)
class MethodError:
    """Found minus true, by measurement, of one picture by one method and some cues."""

    method: str
    cues: Cues
    person: str
    errors: Mapping[str, float]


def method_errors(name: str) -> list[MethodError]:
    """Fit one picture by every method."""
    picture = picture_of(name)
    request = changed(picture.request, cues=Cues.SES, force=True)
    found: list[MethodError] = []
    for method in METHODS:
        by_ours = method == OURS
        asked = replace(
            request, choices=replace(request.choices, paper=None if by_ours else Paper())
        )
        with _additions(
            shape=SHAPE in method or "both" in method, pose=POSE in method or "both" in method
        ):
            result = fit(asked)
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
    """Mean absolute errors of each method, with their standard errors over people.

    Below, by how much this package's method errs more than the paper's.
    """
    heads = "".join(f"{f'{name} {unit}':>15s}" for name, _, unit in MEASUREMENTS)
    lines = [f"{'':38s}{'cues':5s}{heads}"]
    for method in METHODS:
        for cues in Cues:
            chosen = [each for each in found if each.method == method and each.cues is cues]
            cells = [_cell(chosen, key) for _, key, _ in MEASUREMENTS]
            lines.append(f"{method:38s}{cues.value:5s}" + "".join(f"{each:>15s}" for each in cells))
    for cues in Cues:
        ours, papers = (
            [each for each in found if each.method == method and each.cues is cues]
            for method in (OURS, PAPER)
        )
        cells = [_difference(ours, papers, key) for _, key, _ in MEASUREMENTS]
        title = "this package's - the paper's"
        lines.append(f"{title:38s}{cues.value:5s}" + "".join(f"{each:>15s}" for each in cells))
    return lines


def _cell(chosen: Sequence[MethodError], key: str) -> str:
    values = np.array([abs(each.errors[key]) for each in chosen])
    return f"{values.mean():.2f} ± {_spread([each.person for each in chosen], values):.2f}"


def _difference(ours: Sequence[MethodError], papers: Sequence[MethodError], key: str) -> str:
    changes = np.array(
        [abs(a.errors[key]) - abs(b.errors[key]) for a, b in zip(ours, papers, strict=True)]
    )
    return f"{changes.mean():+.2f} ± {_spread([each.person for each in ours], changes):.2f}"


def _spread(people: Sequence[str], values: np.ndarray) -> float:
    """Standard error of the mean, over people, who are independent."""
    who = np.array(people)
    means = [values[who == person].mean() for person in dict.fromkeys(people)]
    return float(np.std(means, ddof=1) / len(means) ** 0.5) if len(means) > 1 else float("nan")


def _measured(result: FitResult, cues: Cues) -> dict[str, float]:
    stage = result.stages[-1]
    if cues is Cues.SE:
        stage = next((each for each in result.stages if each.name == "SE"), stage)
    return {each.name: each.value for each in stage.measurements}


@contextmanager
def _additions(*, shape: bool, pose: bool) -> Iterator[None]:
    """What the paper's method does not have, added to its energies."""
    plain = paper._energy  # pyright: ignore[reportPrivateUsage]

    def with_terms(*given: object, **named: object) -> JointObjective:
        *others, counted = given
        assert isinstance(counted, frozenset)
        return plain(*others, counted | ADDED_TERMS, **named)  # pyright: ignore

    with ExitStack() as patched:
        if shape:
            patched.enter_context(mock.patch.object(paper, "no_prior", population_prior))
        if pose:
            patched.enter_context(mock.patch.object(paper, "_energy", with_terms))
        yield
