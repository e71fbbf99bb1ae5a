"""How measurements and poses gain with more pictures of one person."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

from fitter.arrays import Vertices
from fitter.body.model import regress
from fitter.fits.pipeline import fit
from fitter.measurement.quantity import Measurement
from fitter.person.fitted_person import FittedPerson
from fitter.request import FitRequest
from fitter.vocabulary.choices import Cues
from tests.evaluation.joint_figures import joint_error_mm
from tests.evaluation.landmark_points import packaged_model
from tests.evaluation.limbs_in_depth import wrong_limbs
from tests.evaluation.scene import Case
from tests.evaluation.scoring import fit_picture
from tests.evaluation.suite import case_picture
from tests.evaluation.true_picture import Told
from tests.evaluation.truth import TrueBody
from tests.one_picture import together


@dataclass(frozen=True, slots=True, kw_only=True)
class Posed:
    """How well a body stands in one picture."""

    joint_mm: float
    wrong_limbs: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SeveralPictures:
    """What so many pictures of one person say.

    ``errors`` and ``standard_errors`` are by measurement; ``before`` and ``after`` hold the poses
    in the pictures, by their own fits and with the shape that they have in common.
    """

    pictures: int
    errors: dict[str, float]
    standard_errors: dict[str, float]
    before: tuple[Posed, ...]
    after: tuple[Posed, ...]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Fitted:
    person: FittedPerson
    request: FitRequest
    measurements: tuple[Measurement, ...]
    truth: TrueBody
    true_joints: Vertices
    posed: Posed


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
        fits = [_fitted(case) for case in cases if case.person == person]
        for each in fits:
            yield _compared([each], each.measurements, (each.posed,), names)
        for count in range(2, len(fits) + 1):
            for chosen in combinations(fits, count):
                found = fit(together(*(each.request for each in chosen)))
                after = [
                    _posed(view.found.posed_vertices, each.true_joints, each.person)
                    for view, each in zip(found.views, chosen, strict=True)
                ]
                yield _compared(chosen, found.measurements, after, names)


def _fitted(case: Case) -> _Fitted:
    picture = case_picture(case)
    result = fit_picture(picture, Cues.SES, Told()).result
    person = result.person
    return _Fitted(
        person=person,
        request=picture.request,
        measurements=result.measurements,
        truth=picture.truth,
        true_joints=picture.joints,
        posed=_posed(result.found.posed_vertices, picture.joints, person),
    )


def _posed(vertices: Vertices, true_joints: Vertices, person: FittedPerson) -> Posed:
    joints = regress(packaged_model(person.gender).joint_regressor, vertices)
    return Posed(
        joint_mm=joint_error_mm(joints, true_joints),
        wrong_limbs=len(wrong_limbs(joints, true_joints)),
    )


def _compared(
    fits: Sequence[_Fitted],
    measurements: Sequence[Measurement],
    after: Sequence[Posed],
    names: Sequence[str],
) -> SeveralPictures:
    found = {each.name: each for each in measurements}
    true = fits[0].truth.measurements
    return SeveralPictures(
        pictures=len(fits),
        errors={name: found[name].value - true[name] for name in names},
        standard_errors={name: found[name].standard_error or 0.0 for name in names},
        before=tuple(each.posed for each in fits),
        after=tuple(after),
    )
