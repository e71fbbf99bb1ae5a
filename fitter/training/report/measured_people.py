"""People measured as the service does, for several sections of the report: each measured once."""

from functools import lru_cache

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.measurement.anthropometry import measurement_values, measuring_body
from fitter.training.report.evaluation import bodies_as_axes
from fitter.training.report.reported import Reported

PEOPLE = 1000
"""Drawn from the model."""

BATCH = 50
"""Bodies measured together; each is an axis of a model and takes 1 MB of it."""

_SEED = 20120101


@lru_cache(maxsize=1)
def drawn_people(reported: Reported) -> Float[np.ndarray, "s d"]:
    """(s, d) every measurement of :data:`PEOPLE` people drawn from the model's N(0, I)."""
    return drawn_measurements(reported.model, PEOPLE, np.random.default_rng(_SEED))


@lru_cache(maxsize=1)
def held_out_people(reported: Reported) -> Float[np.ndarray, "s d"]:
    """(s, d) every measurement of the held-out bodies themselves."""
    return measured_bodies(reported.model, reported.bodies.rest)


def drawn_measurements(
    model: BodyModel, count: int, rng: np.random.Generator
) -> Float[np.ndarray, "s d"]:
    """Every measurement of people drawn from the model's N(0, I), in the definitions' order."""
    body = measuring_body(model, ScapeEvaluator(model))
    shapes = rng.normal(size=(count, len(model.shape_basis)))
    return np.stack([measurement_values(body, shape) for shape in shapes])


def measured_bodies(model: BodyModel, rest: Float[np.ndarray, "s m 3"]) -> Float[np.ndarray, "s d"]:
    """Every measurement of whole bodies, in the order and units of the definitions.

    The model poses them; their shapes are their own.
    """
    rows = []
    for start in range(0, len(rest), BATCH):
        exact = bodies_as_axes(model, rest[start : start + BATCH])
        body = measuring_body(exact, ScapeEvaluator(exact))
        rows.extend(measurement_values(body, axis) for axis in np.eye(len(exact.shape_basis)))
    return np.stack(rows)
