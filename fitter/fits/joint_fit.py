"""One shape from several pictures of one person, with pose, light and reflectance of each.

With a common shape β and what belongs to each picture alone, θ_k (pose, position, light,
reflectance), the energy

    E(β) + w Σ_k E_k(β, θ_k),    w = 1 / (1 + (K - 1) 0.4),

is minimised over β, with each E_k replaced by the paraboloid that the picture's own fit left
(:mod:`fitter.optimizer.shape_likelihood`). Pictures of one person share part of their errors, so K
of them count for fewer than K (:data:`fitter.applications.several_pictures.SHARED_ERROR`). The
shape is then held, and what belongs to each picture is refitted. Searching every picture once more
for the shape too, given what the others say, gained nothing on the evaluation's tuning half
(DECISIONS.md).
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.applications.several_pictures import (
    CombinedShape,
    combined_shape,
    counted_as,
    known_covariance,
    told_differently,
)
from fitter.arrays import Shape
from fitter.energies.priors import population_prior
from fitter.fits.prepared_model import prepared_model
from fitter.fits.refit import refit
from fitter.optimizer.gauss_newton import EnergyObserver
from fitter.optimizer.shape_likelihood import most_probable_shape, prior_with, shape_likelihood
from fitter.person.fitted_person import FittedPerson
from fitter.population.known_person import known_person
from fitter.request import STATURE, FitRequest
from fitter.result import PictureFit

# A search reports its energies about thirty times; the exact number is not known in advance.
_STEP_SHARE = 0.05


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
    evaluator = prepared.operators.evaluator
    attributes = known_person(requests[0], prepared.population, evaluator).attributes
    share = counted_as(len(people)) / len(people)
    # Pictures count in full below and the sum is scaled by the share, so the prior is scaled up.
    population = population_prior(len(fused.shape))
    prior = replace(population, precision=population.precision / share)
    likelihoods = [
        shape_likelihood(
            person.body.shape, known_covariance(person), prior=population, attributes=attributes
        )
        for person in people
    ]
    everything = prior_with(prior, likelihoods)
    shape, covariance = most_probable_shape(
        replace(everything, precision=share * everything.precision),
        attributes,
        people[0].body.shape,
    )
    steps = _Steps(observe, count=len(people))
    pictures: list[PictureFit] = []
    for request, person in zip(requests, people, strict=True):
        with steps.next() as report:
            pictures.append(
                refit(
                    request,
                    prepared,
                    replace(person.body, shape=shape),
                    prior=population,
                    hold_shape=True,
                    report=report,
                    detector_weights=detector_weights,
                )
            )
    return JointFit(
        shape=shape,
        covariance=covariance + _spread_of_height(known_covariance(people[0])),
        pictures=tuple(pictures),
        fused=fused,
    )


class _Steps:
    """Progress over refits, each of which reports its energies from time to time."""

    def __init__(self, observe: Callable[[float], None], *, count: int) -> None:
        self._observe = observe
        self._count = count
        self._done = 0

    @contextmanager
    def next(self) -> Iterator[EnergyObserver]:
        """Run one refit; the yielded function takes its energies."""
        within = 0.0

        def report(_: Mapping[str, float]) -> None:
            nonlocal within
            within += _STEP_SHARE * (1.0 - within)
            self._observe((self._done + within) / self._count)

        yield report
        self._done += 1
        self._observe(self._done / self._count)


def _spread_of_height(covariance: Float[np.ndarray, "n n"]) -> Float[np.ndarray, "n n"]:
    """What an unknown height adds to the covariance, v r rᵀ with the shape's response r to it.

    It is the one the fits already have: pictures say nothing about it.
    """
    if covariance[0, 0] <= 0.0:
        return np.zeros_like(covariance)
    return np.outer(covariance[0], covariance[0]) / covariance[0, 0]


def _check_same_knowledge(requests: Sequence[FitRequest]) -> None:
    told = [
        {name: (known.value, known.standard_error) for name, known in each.measurements.items()}
        | {STATURE: each.height_m}
        for each in requests
    ]
    for index, each in enumerate(told):
        if each != told[0]:
            raise told_differently(index)
