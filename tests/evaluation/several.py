"""How measurements tighten with more pictures of one person."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from fitter.applications.fitted_person import FittedPerson, fitted_person
from fitter.applications.several_pictures import combined_shape
from fitter.fittable import packaged_body
from fitter.measurement.anthropometry import measure
from fitter.measurement.quantity import Measurement
from fitter.request import Cues
from tests.evaluation.landmark_points import packaged_model
from tests.evaluation.scene import Case
from tests.evaluation.suite import Told, fit_case
from tests.evaluation.truth import TrueBody


@dataclass(frozen=True, slots=True, kw_only=True)
class SeveralPictures:
    """What so many pictures of one person say of a measurement."""

    pictures: int
    name: str
    error: float
    standard_error: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Fitted:
    person: FittedPerson
    measurements: tuple[Measurement, ...]
    given: tuple[str, ...]


def several_pictures(cases: Sequence[Case], names: Sequence[str]) -> Iterator[SeveralPictures]:
    """Fit every picture, and combine each person's in every choice of one, two, three, ...

    Parameters
    ----------
    cases
        Pictures, some of the same people.
    names
        Of the measurements that are compared with the truth.
    """
    for person in dict.fromkeys(case.person for case in cases):
        fits: list[_Fitted] = []
        truth: TrueBody | None = None
        for case in cases:
            if case.person == person:
                fitted = fit_case(case, Cues.SES, Told())
                result, truth = fitted.result, fitted.truth
                model = packaged_model(result.gender)
                fits.append(
                    _Fitted(
                        person=fitted_person(result, model),
                        measurements=result.measurements,
                        given=result.given,
                    )
                )
        assert truth is not None
        for count in range(1, len(fits) + 1):
            for chosen in combinations(fits, count):
                found = {each.name: each for each in _measured(chosen)}
                for name in names:
                    error = found[name].standard_error
                    assert error is not None
                    yield SeveralPictures(
                        pictures=count,
                        name=name,
                        error=found[name].value - truth.measurements[name],
                        standard_error=error,
                    )


def _measured(fits: Sequence[_Fitted]) -> tuple[Measurement, ...]:
    if len(fits) == 1:
        return fits[0].measurements
    combined = combined_shape([each.person for each in fits])
    return measure(
        packaged_body(fits[0].person.gender).measuring,
        combined.shape,
        shape_covariance=combined.covariance,
        given=fits[0].given,
        held=fits[0].given,
    )
