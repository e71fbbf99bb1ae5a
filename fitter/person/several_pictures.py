"""One shape from several pictures of one person, each with its own pose and light (section 7).

Near its minimum the energy of picture k is a paraboloid over the shape β, once pose, place and
light have been minimised out: ½ (β - β_k)ᵀ H_k (β - β_k), the prior ½ βᵀ P β included. The person's
energy is the sum of the pictures' and of one prior, and its minimum a linear solve. What pictures
of one person err in alike (shapes the model does not have, cloth, a prior about how people stand)
more of them do not mend, so that they count as fewer than they are.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.special import chdtrc

from fitter.arrays import Shape
from fitter.energies.shape_terms import POPULATION_PRECISION, height_extrapolation, population_prior
from fitter.errors import InvalidInputError
from fitter.person.fitted_person import FittedPerson

SHARED_ERROR = 0.4
"""Correlation of the errors of two pictures of one person, by which k pictures count as
k / (1 + (k - 1) 0.4). On the evaluation's tuning half 95 % intervals then hold 92 and 92 % from two
and three pictures, as they do 91 % from one; without it 88 and 85 %."""

MOST_PICTURES = 12

SAME_PERSON_PROBABILITY = 0.1
"""Shapes that differ so much that pictures of one person would do so more rarely than this. By
``python -m tests.evaluation --strangers`` no pair of one person is below it (the least 0.14), of
124 pairs with a stranger 97: all 67 whose trunks differ by 20 cm or more, 23 of 36 by 10 to 20."""

_CERTAIN = 1.0 - 1e-12

_SAME_HEIGHT, _HELD_WITHIN = 0.01, 0.3
"""Standard deviations by which what was given may seem to differ: what is held is a curved surface,
and the directions in which it is free are those at the first of the fits."""

_GIVEN_VARIANCE = 1e-9
"""Along what was given the shape does not vary."""


_LEAST_SPREAD = 0.1
"""Standard deviations of a shape that nothing tells apart: pictures that both say nothing in a
direction agree in it because of the prior, and those that both know it well, only to about this."""

_LONGER_TAILS = 1.3
"""Errors of a fit vary by so much more than its matrix knows: of 95 % intervals 91 % hold."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CombinedShape:
    """The shape of one person.

    Attributes
    ----------
    shape, covariance
        (n,), (n, n) coefficients and how certain they are.
    agreement
        Probability that shapes fitted to pictures of one person differ as much as these, for the
        picture that differs most.
    differing
        Which picture that is.
    """

    shape: Shape
    covariance: Float[np.ndarray, "n n"]
    agreement: float
    differing: int

    @property
    def doubtful(self) -> bool:
        """Whether the pictures seem to show different people."""
        return self.agreement < SAME_PERSON_PROBABILITY


def combined_shape(people: Sequence[FittedPerson]) -> CombinedShape:
    """The most probable shape of a person of whom several pictures were fitted.

    Parameters
    ----------
    people
        The fits, two at least, of one gender, model and height.

    Raises
    ------
    InvalidInputError
        If they are too few or too many, were fitted with different models, or were told different
        things of the person.
    """
    _check_kinds(people)
    origin = people[0].body.shape
    directions = _free_directions(people)
    steps = [directions.T @ (person.body.shape - origin) for person in people]
    for index, (person, step) in enumerate(zip(people, steps, strict=True)):
        beside = np.abs(person.body.shape - origin - directions @ step)
        if beside[0] > _SAME_HEIGHT or beside.max() > _HELD_WITHIN:
            raise told_differently(index)
    count = len(people)
    weight = counted_as(count) / count
    # The fits' covariances are wider where the height is unusual, and so is their prior's.
    wider = height_extrapolation(float(origin[0]))
    precision = directions.T @ population_prior(len(origin)).precision @ directions / wider
    prior_step = -directions.T @ origin
    matrix, pull = precision.copy(), precision @ prior_step
    informations = [_information(person, directions, precision) for person in people]
    for information, step in zip(informations, steps, strict=True):
        # What the picture says, without the prior: H_k - P, at whose minimum lies H_k t_k - P t_0.
        matrix += weight * (information - precision)
        pull += weight * (information @ step - precision @ prior_step)
    covariance = np.linalg.inv(matrix)
    step = covariance @ pull
    agreements = [
        _agreement(index, informations, steps, precision, prior_step)
        for index in range(len(people))
    ]
    return CombinedShape(
        shape=origin + directions @ step,
        covariance=directions @ covariance @ directions.T,
        agreement=min(1.0, _looked_at(count) * min(agreements)),
        differing=int(np.argmin(agreements)),
    )


def counted_as(pictures: int, *, shared: float = SHARED_ERROR) -> float:
    """How many pictures that err each by itself say as much as so many of one person."""
    return pictures / (1.0 + (pictures - 1) * shared)


def known_covariance(person: FittedPerson) -> Float[np.ndarray, "n n"]:
    """Covariance of a fit's shape; fits that have none have been refused."""
    assert person.shape_covariance is not None
    return person.shape_covariance


def told_differently(index: int) -> InvalidInputError:
    """The refusal of a fit that was told something else of the person than the first."""
    return _unusable(
        index,
        "The fits were told different heights or other measurements of the person.",
        "Fit every picture with the same height and the same known measurements.",
    )


def _agreement(
    index: int,
    informations: Sequence[Float[np.ndarray, "d d"]],
    steps: Sequence[Float[np.ndarray, " d"]],
    precision: Float[np.ndarray, "d d"],
    prior_step: Float[np.ndarray, " d"],
) -> float:
    """Probability of so large a difference between one picture and the others together."""
    count = len(steps)
    weight = counted_as(count - 1) / (count - 1)
    matrix, pull = precision.copy(), precision @ prior_step
    for other in range(count):
        if other != index:
            matrix += weight * (informations[other] - precision)
            pull += weight * (informations[other] @ steps[other] - precision @ prior_step)
    rest = np.linalg.solve(matrix, pull)
    # Each posterior's mean keeps M = H⁻¹ (H - P) of the truth, the rest is the prior's: their
    # difference varies by the noise of both, M H⁻¹, less what both err in alike, and by the truth
    # that one keeps more of. That varies as among people, by less than the prior of a fit allows.
    own, others = np.linalg.inv(informations[index]), np.linalg.inv(matrix)
    identity = np.eye(len(prior_step))
    kept, kept_by_others = identity - own @ precision, identity - others @ precision
    unlike = kept - kept_by_others
    noise = (1.0 - SHARED_ERROR) * (kept @ own + kept_by_others @ others)
    spread = noise + POPULATION_PRECISION * unlike @ np.linalg.solve(precision, unlike.T)
    values, vectors = np.linalg.eigh(0.5 * (spread + spread.T))
    squares = (vectors.T @ (steps[index] - rest)) ** 2 / (values + _LEAST_SPREAD**2)
    return _as_extreme(squares / _LONGER_TAILS)


def _looked_at(count: int) -> int:
    """How many differences there are among which one may be large by chance; two have but one."""
    return count if count > 2 else 1


def _as_extreme(squares: Float[np.ndarray, " d"]) -> float:
    """Probability of independent squared deviations like these: of the largest, or their sum.

    People differ most in how heavy they are, along one or two directions among many; the sum alone
    would lose them. The smaller probability counts twice, because there are two.
    """
    count = len(squares)
    rarest = min(float(chdtrc(1, squares.max())), _CERTAIN)
    largest = -np.expm1(count * np.log1p(-rarest))
    together = chdtrc(count, squares.sum())
    return float(min(1.0, 2.0 * min(largest, together)))


def _free_directions(people: Sequence[FittedPerson]) -> Float[np.ndarray, "n d"]:
    """Orthonormal directions of the shape that were not given."""
    values, vectors = np.linalg.eigh(known_covariance(people[0]))
    return vectors[:, values > _GIVEN_VARIANCE]


def _information(
    person: FittedPerson, directions: Float[np.ndarray, "n d"], precision: Float[np.ndarray, "d d"]
) -> Float[np.ndarray, "d d"]:
    """H_k, no less than P: where findings widened errors, a fit may seem to say less."""
    found = np.linalg.inv(directions.T @ known_covariance(person) @ directions)
    values, vectors = np.linalg.eigh(0.5 * (found + found.T) - precision)
    return precision + (vectors * np.maximum(values, 0.0)) @ vectors.T


def _check_kinds(people: Sequence[FittedPerson]) -> None:
    if not 2 <= len(people) <= MOST_PICTURES:
        raise _unusable(
            None,
            f"One person is combined from 2 to {MOST_PICTURES} fits, not from {len(people)}.",
            "Name other finished fits of the same person.",
        )
    first = people[0]
    for index, person in enumerate(people):
        if person.shape_covariance is None:
            raise _unusable(
                index,
                "The fit does not say how certain its shape is.",
                "Fit the picture again, without `paper`.",
            )
        if (person.gender, person.model_checksum) != (first.gender, first.model_checksum):
            raise _unusable(
                index,
                "The fits were made with different body models.",
                "Fit every picture with the same gender and the same version of the service.",
            )


def _unusable(index: int | None, reason: str, remedy: str) -> InvalidInputError:
    """``index`` is that of the fit at fault, None for all of them.

    A caller names the others beside the first, and knows their places by ``fits``.
    """
    return InvalidInputError(
        code="fits-unusable",
        field=f"fits.{index - 1}" if index else "fits",
        reason=reason,
        remedy=remedy,
    )
