"""Widening of a shape's errors by what harms a picture, and what is then hardly known.

For light, blur and size the factors are the root mean squares of errors over standard errors on
spoilt pictures of 14 people of the tuning halves, 84 fits with shading: they make them one again.
So are those of eleven people who are cut off at shins, thighs, hips or waist, 42 fits: the worst of
the four counts. A near camera has that by which errors grew in two pictures (MEASURING.md).
What is not in the table cost nothing measurable (a rolled camera, arms at the trunk, too much
light), is in the fit's own errors already (loose clothes, things before the person), or cannot be
put in figures (another person was taken).
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.measurement.anthropometry import MeasuringBody, measurement_jacobian
from fitter.measurement.definitions import Measurement
from fitter.population.body_estimate import estimate_body
from fitter.population.conditional_shape import MeasuredPopulation
from fitter.population.known_person import KnownPerson
from fitter.request import KnownMeasurement
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE, STATURE, WEIGHT
from fitter.vocabulary.remarks import Code, Note, Remark, Severity, remark


@dataclass(frozen=True, slots=True, kw_only=True)
class Harm:
    """Factors of the standard errors of four measurements.

    Attributes
    ----------
    chest
        Of the chest girth.
    waist
        Of the smallest waist.
    hip
        Of the hip girth.
    weight
        Of the weight.
    """

    chest: float = 1.0
    waist: float = 1.0
    hip: float = 1.0
    weight: float = 1.0


_SMALL: Final = Harm(chest=1.1, waist=1.6, hip=1.1, weight=1.6)

HARM: Final[Mapping[str, Harm]] = {
    Code.BLURRED: Harm(waist=1.7, hip=1.2, weight=1.4),
    Code.TOO_DARK: Harm(chest=1.2, waist=1.8, hip=1.3, weight=1.7),
    Code.PERSON_TOO_SMALL: _SMALL,
    Code.PICTURE_TOO_SMALL: _SMALL,
    Code.CAMERA_TOO_NEAR: Harm(chest=1.6, waist=1.2, hip=1.2, weight=1.4),
    # Of 12 people in clothes and 12 in underwear, in pictures without colours.
    Code.SKIN_NOT_FOUND: Harm(waist=1.3, hip=1.2, weight=1.7),
    Code.CUT_OFF: Harm(chest=1.4, waist=1.3, hip=1.2, weight=1.5),
    # Of eight people squeezed to 0.75 or stretched to 1.3 of their height, 15 fits.
    Code.SQUEEZED: Harm(chest=4.7, waist=5.6, hip=5.1, weight=7.3),
    # Of twelve people half behind others: 1.5 times what makes errors as large as stated, the upper
    # end of what so few allow.
    Code.NOBODY_FOUND: Harm(chest=1.5, waist=2.0, hip=1.6, weight=1.5),
    # Of nine people rendered seated, 15 fits; hips erred less, but who crouches hides them.
    Code.NOT_STANDING: Harm(chest=2.1, waist=2.4, hip=2.0, weight=2.2),
}

_FACTORS: Final[Mapping[str, Callable[[Harm], float]]] = {
    "chest_girth": lambda harm: harm.chest,
    "waist_girth_smallest": lambda harm: harm.waist,
    "hip_girth": lambda harm: harm.hip,
    WEIGHT: lambda harm: harm.weight,
}
"""The measurements whose standard errors grow by exactly these factors. Others grow as far as their
errors go along with these."""

_LEAST_VARIANCE: Final = 1e-6
"""Variance below which a measurement counts as given."""


def widened_covariance(
    covariance: Float[np.ndarray, "n n"],
    body: MeasuringBody,
    shape: Shape,
    pictures: Sequence[Sequence[Remark]],
    given: Collection[str],
) -> Float[np.ndarray, "n n"]:
    """The covariance of a shape that the findings leave; the same where nothing harms.

    Of one picture's findings the worst factor counts, of several pictures' the least: what one
    does not show another may. With the derivatives J of the four measurements in the table, of the
    stature and of what was given, errors of the shape are stretched along what these tell of it,

        Σ' = T Σ Tᵀ,  T = 1 + Σ Jᵀ (J Σ Jᵀ)⁻¹ (D - 1) J,

    so that J Σ' Jᵀ = D J Σ Jᵀ D, and what is not told by these measurements stays. A factor k is
    that of the standard error with what shapes leave unexplained, u:
    d² = (k² (s² + u²) - u²) / s², where s is the error by the shape. Stature and what was given
    keep theirs.
    """
    factors = {
        name: 1.0 if name in given else _factor(of, pictures) for name, of in _FACTORS.items()
    }
    if all(factor == 1.0 for factor in factors.values()):
        return covariance
    names = [each.about.name for each in body.definitions]
    kept = dict.fromkeys([*factors, STATURE, *given])
    rows = [names.index(name) for name in kept if name in names]
    jacobian = measurement_jacobian(body, shape)[rows]
    variances = np.einsum("kn,nj,kj->k", jacobian, covariance, jacobian)
    free = variances > _LEAST_VARIANCE
    rows, jacobian, variances = list(np.array(rows)[free]), jacobian[free], variances[free]
    factor = np.array([factors.get(names[row], 1.0) for row in rows])
    unexplained = body.unexplained[rows] ** 2
    stretch = np.sqrt((factor**2 * (variances + unexplained) - unexplained) / variances)
    stretch[factor == 1.0] = 1.0
    along = covariance @ jacobian.T @ np.linalg.pinv(jacobian @ covariance @ jacobian.T)
    turned = np.eye(len(covariance)) + along @ ((stretch - 1.0)[:, None] * jacobian)
    widened = turned @ covariance @ turned.T
    return 0.5 * (widened + widened.T)


def _factor(of: Callable[[Harm], float], pictures: Sequence[Sequence[Remark]]) -> float:
    return min(
        (
            max(
                (
                    of(HARM.get(found.code, Harm()))
                    for found in findings
                    if found.severity is Severity.HARMS
                ),
                default=1.0,
            )
            for findings in pictures
        ),
        default=1.0,
    )


_SHOWN: Final = 0.1
"""Centimetres or kilograms to which measurements are shown."""


def hardly_known(
    measurements: Sequence[Measurement],
    population: MeasuredPopulation,
    known: KnownPerson,
    findings: Collection[Remark],
) -> tuple[Remark, ...]:
    """Warning that names what a picture says less of than gender and height do, if anything.

    That is what was not given and has a standard error above the people's own spread, both with
    what shapes leave unexplained. Only where clothes or findings widen errors: elsewhere it is true
    of crotch rises alone, of which no picture says anything.
    """
    if not any(found.code in HARM or found.code == Code.CLOTHES_LOOSE for found in findings):
        return ()
    height = KnownMeasurement(value=CENTIMETRES_PER_METRE * known.height_m)
    people = estimate_body(population, {STATURE: height} if STATURE in known.given else {})
    spreads = np.hypot(
        [each.standard_error or 0.0 for each in people.measurements], population.body.unexplained
    )
    names = [
        each.name
        for each, spread in zip(measurements, spreads, strict=True)
        if each.name not in known.given and (each.standard_error or 0.0) > spread + _SHOWN
    ]
    reason = (
        "Withheld, for their 95 % ranges are wider than those of all people of the gender and "
        f"height: {', '.join(names)}."
    )
    return (remark(Note.MEASUREMENTS_WITHHELD, reason, where=names),) if names else ()
