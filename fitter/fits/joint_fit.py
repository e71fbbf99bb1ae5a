"""One shape from several finished fits of one person, with pose and light of each picture.

Every picture is searched again with the others (:mod:`fitter.fits.joint_search`), from the body
that its own fit found and the shape that the fits agree on.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.fits.detecting import detector_for
from fitter.fits.joint_search import search_jointly
from fitter.fits.joint_view import view_around
from fitter.fits.prepared_model import prepared_model
from fitter.observation.observation import observe as observed
from fitter.optimizer.free_space import held_shape
from fitter.person.fitted_person import FittedPerson
from fitter.person.several_pictures import CombinedShape, combined_shape, told_differently
from fitter.population.known_person import known_person
from fitter.request import FitRequest
from fitter.result import PictureFit
from fitter.vocabulary.measurements import STATURE

# Each report of energies takes this share of what is left: their number is not known in advance.
_STEP_SHARE = 0.03


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointFit:
    """One person fitted to several pictures.

    Attributes
    ----------
    shape, covariance
        (n,) coefficients and their (n, n) covariance.
    pictures
        Each picture's fit with this shape, in the order given.
    fused
        What the fits said of the shape before they were redone.
    """

    shape: Shape
    covariance: Float[np.ndarray, "n n"]
    pictures: tuple[PictureFit, ...]
    fused: CombinedShape


def joint_fit(
    people: Sequence[FittedPerson],
    requests: Sequence[FitRequest],
    *,
    models: Path | None = None,
    detector_weights: Path | None = None,
    observe: Callable[[float], None],
) -> JointFit:
    """Fit one person to all pictures, starting from a fit of each.

    Parameters
    ----------
    people
        The fits, at least two, of one gender, model and height.
    requests
        The requests they answered.
    models
        Folder with the body models, None for those of the package.
    detector_weights
        Folder with the detector's weights, None for those of their package.
    observe
        Receives the share of the work done, in [0, 1].

    Raises
    ------
    InvalidInputError
        If the fits are too few or too many, were made with different models, or differ in what the
        caller said about the person.
    """
    fused = combined_shape(people)
    _check_same_knowledge(requests)
    prepared = prepared_model(people[0].gender, models=models)
    known = known_person(requests[0], prepared.population, prepared.operators.evaluator)
    views = [
        view_around(
            request,
            observed(request, detector_for(request, detector_weights)),
            prepared,
            known,
            person.body,
        )
        for request, person in zip(requests, people, strict=True)
    ]
    done = 0.0

    def report(_: Mapping[str, float]) -> None:
        nonlocal done
        done += _STEP_SHARE * (1.0 - done)
        observe(done)

    found = search_jointly(views, known, held_shape(known.attributes.held, fused.shape), report)
    observe(1.0)
    return JointFit(
        shape=found.shape, covariance=found.covariance, pictures=found.pictures, fused=fused
    )


def _check_same_knowledge(requests: Sequence[FitRequest]) -> None:
    told = [
        {name: (known.value, known.standard_error) for name, known in each.measurements.items()}
        | {STATURE: each.height_m}
        for each in requests
    ]
    for index, each in enumerate(told):
        if each != told[0]:
            raise told_differently(index)
