"""The person a fit starts from, given all that the caller knows (sections 3.1 and 4)."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fitter.arrays import Shape
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape, shape_for_height, shape_with_height
from fitter.energies.shape_terms import NOTHING_KNOWN, Attributes, KnownAttributes
from fitter.observation.subject import subject_height
from fitter.optimizer.free_space import held_shape
from fitter.population.conditional_shape import MeasuredPopulation, height_warnings
from fitter.population.known import conditioned_population
from fitter.request import KnownMeasurement, Person
from fitter.vocabulary.measurements import CENTIMETRES_PER_METRE, STATURE
from fitter.vocabulary.remarks import Note, Remark, assumed


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class KnownPerson:
    """The most probable person of a gender and known measurements.

    Attributes
    ----------
    height_m
        The caller's, or the most probable.
    height_variance
        How uncertain it is, in squared standard deviations of the population.
    shape
        (n,) coefficients; has the height and the held attributes.
    attributes
        What is known besides the height.
    given
        Names of all that the caller gave, the height as stature.
    held
        Names of those given without an error: every body of the fit has them.
    assumptions
        The height, if it was not given.
    warnings
        Of a height that few have.
    """

    height_m: float
    height_variance: float
    shape: Shape
    attributes: KnownAttributes
    given: tuple[str, ...]
    held: tuple[str, ...]
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]


def known_person(
    person: Person, population: MeasuredPopulation, evaluator: ScapeEvaluator
) -> KnownPerson:
    """Find the most probable person with this gender, height and measurements.

    With a height or nothing this is the mean person of the height. Measurements make some heights
    more probable than others: without a height the most probable one is taken. The picture says
    nothing of size, so the height is not estimated any further.

    Raises
    ------
    InvalidInputError
        If a name is not measured, or nobody has such measurements; the problem names them.
    """
    if not person.measurements:
        height_m, assumptions = subject_height(person)
        given = () if assumptions else (STATURE,)
        return KnownPerson(
            height_m=height_m,
            height_variance=1.0 if assumptions else 0.0,
            shape=shape_for_height(evaluator, height_m),
            attributes=NOTHING_KNOWN,
            given=given,
            held=given,
            assumptions=assumptions,
            warnings=height_warnings(population, height_m),
        )
    known = _height_of(person) | dict(person.measurements)
    conditioned = conditioned_population(population, known)
    height_m, assumptions = _height(known, height_of_shape(evaluator, conditioned.shape))
    attributes = _attributes(population, known)
    shape = shape_with_height(evaluator, conditioned.shape, height_m)
    return KnownPerson(
        height_m=height_m,
        height_variance=max(float(conditioned.covariance[0, 0]), 0.0),
        shape=held_shape(attributes.held, shape),
        attributes=attributes,
        given=tuple(known),
        held=tuple(name for name, each in known.items() if not each.standard_error),
        assumptions=assumptions,
        warnings=height_warnings(population, height_m),
    )


def _height_of(person: Person) -> dict[str, KnownMeasurement]:
    if person.height_m is None:
        return {}
    stature_cm = CENTIMETRES_PER_METRE * person.height_m
    return {STATURE: KnownMeasurement(value=stature_cm, field="height_m")}


def _height(
    known: Mapping[str, KnownMeasurement], most_probable_m: float
) -> tuple[float, tuple[Remark, ...]]:
    stature = known.get(STATURE)
    if stature is None:
        said = assumed(
            Note.HEIGHT_ASSUMED,
            f"No height was given; the most probable one of people of the gender with "
            f"{', '.join(known)} as given, {most_probable_m:.2f} m, was taken.",
            where=("height_m",),
        )
        return most_probable_m, (said,)
    if stature.standard_error:
        return most_probable_m, ()
    return stature.value / CENTIMETRES_PER_METRE, ()


def _attributes(
    population: MeasuredPopulation, known: Mapping[str, KnownMeasurement]
) -> KnownAttributes:
    """All but the stature, which the height coefficient holds."""
    others = {name: each for name, each in known.items() if name != STATURE}
    uncertain = {name: each for name, each in others.items() if each.standard_error}
    held = {name: each for name, each in others.items() if not each.standard_error}
    return replace(
        NOTHING_KNOWN,
        held=_measured(population, held),
        uncertain=_measured(population, uncertain),
        standard_errors=np.array([each.standard_error for each in uncertain.values()]),
    )


def _measured(population: MeasuredPopulation, known: Mapping[str, KnownMeasurement]) -> Attributes:
    if not known:
        return NOTHING_KNOWN.held
    shapes = population.only(*known).shapes
    rows = range(len(known))
    return Attributes(
        measure=lambda shape: shapes.measure(shape, rows),
        jacobian=shapes.jacobian,
        values=np.array([each.value for each in known.values()]),
    )
