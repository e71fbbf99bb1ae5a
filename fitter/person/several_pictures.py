"""One shape from several pictures of one person, each fitted by itself (section 7).

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

from fitter.arrays import Shape, ShapeCovariance
from fitter.energies.shape_terms import height_extrapolation, population_prior

SHARED_ERROR = 0.4
"""Correlation of the errors of two pictures of one person, by which k pictures count as
k / (1 + (k - 1) 0.4). On the evaluation's tuning half 95 % intervals then hold 92 and 92 % from two
and three pictures, as they do 91 % from one; without it 88 and 85 %."""

SAME_PERSON_PROBABILITY = 0.1
"""Shapes that differ so much that pictures of one person would do so more rarely than this. Of
pairs of one person none is below it (the least 0.14), of 124 pairs with a stranger 97: all 67 whose
trunks differ by 20 cm or more, 23 of 36 by 10 to 20."""

_CERTAIN = 1.0 - 1e-12

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
    shape
        (n,) its coefficients.
    agreement
        Probability that shapes fitted to pictures of one person differ as much as these, for the
        picture that differs most.
    differing
        Which picture that is.
    """

    shape: Shape
    agreement: float
    differing: int

    @property
    def doubtful(self) -> bool:
        """Whether the pictures seem to show different people."""
        return self.agreement < SAME_PERSON_PROBABILITY


def combined_shape(
    shapes: Sequence[Shape], covariances: Sequence[ShapeCovariance], *, prior: float
) -> CombinedShape:
    """The most probable shape of a person by two pictures or more, fitted each by itself.

    ``prior`` is the precision of the population's prior under which the covariances were found.
    """
    origin = shapes[0]
    values, vectors = np.linalg.eigh(covariances[0])
    # Orthonormal directions of the shape that were not given.
    directions = vectors[:, values > _GIVEN_VARIANCE]
    steps = [directions.T @ (shape - origin) for shape in shapes]
    count = len(shapes)
    # The fits' covariances are wider where the height is unusual, and so is their prior's.
    wider = height_extrapolation(float(origin[0]))
    unscaled = population_prior(len(origin), prior).precision
    precision = directions.T @ unscaled @ directions / wider
    prior_step = -directions.T @ origin
    informations = [_information(each, directions, precision) for each in covariances]
    matrix, pull = _summed(informations, steps, precision, prior_step)
    agreements = [
        _agreement(index, informations, steps, precision, prior_step, prior)
        for index in range(count)
    ]
    return CombinedShape(
        shape=origin + directions @ (np.linalg.inv(matrix) @ pull),
        agreement=min(1.0, _looked_at(count) * min(agreements)),
        differing=int(np.argmin(agreements)),
    )


def _summed(
    informations: Sequence[Float[np.ndarray, "d d"]],
    steps: Sequence[Float[np.ndarray, " d"]],
    precision: Float[np.ndarray, "d d"],
    prior_step: Float[np.ndarray, " d"],
) -> tuple[Float[np.ndarray, "d d"], Float[np.ndarray, " d"]]:
    """Matrix and right side of the minimum of pictures' energies and of one prior."""
    weight = counted_as(len(steps)) / len(steps)
    matrix, pull = precision.copy(), precision @ prior_step
    for information, step in zip(informations, steps, strict=True):
        # What the picture says, without the prior: H_k - P, at whose minimum lies H_k t_k - P t_0.
        matrix += weight * (information - precision)
        pull += weight * (information @ step - precision @ prior_step)
    return matrix, pull


def counted_as(pictures: int, *, shared: float = SHARED_ERROR) -> float:
    """Number of pictures that err each by itself and say as much as so many of one person."""
    return pictures / (1.0 + (pictures - 1) * shared)


def _agreement(
    index: int,
    informations: Sequence[Float[np.ndarray, "d d"]],
    steps: Sequence[Float[np.ndarray, " d"]],
    precision: Float[np.ndarray, "d d"],
    prior_step: Float[np.ndarray, " d"],
    prior: float,
) -> float:
    """Probability of so large a difference between one picture and the others together."""
    others = [other for other in range(len(steps)) if other != index]
    matrix, pull = _summed(
        [informations[other] for other in others],
        [steps[other] for other in others],
        precision,
        prior_step,
    )
    rest = np.linalg.solve(matrix, pull)
    # Each posterior's mean keeps M = H⁻¹ (H - P) of the truth, the rest is the prior's: their
    # difference varies by the noise of both, M H⁻¹, less what both err in alike, and by the truth
    # that one keeps more of. That varies as among people, by less than the prior of a fit allows.
    own, rest_of = np.linalg.inv(informations[index]), np.linalg.inv(matrix)
    identity = np.eye(len(prior_step))
    kept, kept_by_others = identity - own @ precision, identity - rest_of @ precision
    unlike = kept - kept_by_others
    noise = (1.0 - SHARED_ERROR) * (kept @ own + kept_by_others @ rest_of)
    spread = noise + prior * unlike @ np.linalg.solve(precision, unlike.T)
    values, vectors = np.linalg.eigh(0.5 * (spread + spread.T))
    squares = (vectors.T @ (steps[index] - rest)) ** 2 / (values + _LEAST_SPREAD**2)
    return _as_extreme(squares / _LONGER_TAILS)


def _looked_at(count: int) -> int:
    """Number of differences among which one may be large by chance; two have but one."""
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


def _information(
    covariance: ShapeCovariance,
    directions: Float[np.ndarray, "n d"],
    precision: Float[np.ndarray, "d d"],
) -> Float[np.ndarray, "d d"]:
    """H_k, no less than P: where findings widened errors, a fit may seem to say less."""
    found = np.linalg.inv(directions.T @ covariance @ directions)
    values, vectors = np.linalg.eigh(0.5 * (found + found.T) - precision)
    return precision + (vectors * np.maximum(values, 0.0)) @ vectors.T
