"""How well section 4's rotation holds height, weight, a girth and lengths over the surface."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.body.stature import stature_m
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.assemble import height_attribute
from fitter.training.report.evaluation import bodies_as_axes, shape_coefficients
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import note_lines, table_lines
from fitter.training.shapes.attribute_comparisons import blanz_vetter_leak
from fitter.training.shapes.attribute_spaces import attribute_space, gram_of_axes
from fitter.training.shapes.attributes import (
    measurement_attribute,
    path_between_landmarks,
    surface_length_attribute,
)
from fitter.training.shapes.height_rotation import (
    SOLVED_AT_DEVIATIONS,
    Attribute,
    attribute_changes,
)

MILLIMETRES_PER_CENTIMETRE = 10.0
SURFACE_WAYS = (("right_acromion", "right_wrist"), ("cervicale", "crotch"))
"""Landmarks joined over the skin: down the arm, and from the nape to between the legs."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeasuredAttribute:
    """An attribute to be given an axis.

    Attributes
    ----------
    name, unit
        What it is, and what its figures are printed in.
    of_model
        Makes H(β) in that unit from a model.
    of_people
        (s,) the attribute of the held-out bodies themselves.
    """

    name: str
    unit: str
    of_model: Callable[[BodyModel], Attribute]
    of_people: Float[np.ndarray, " s"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AttributeFigures:
    """What became of an attribute in its own basis.

    Attributes
    ----------
    per_deviation
        Gain by one standard deviation of its axis, mean of both ends at three.
    largest_change, mean_change
        Over the other axes, the larger of both ends at three standard deviations.
    blanz_vetter_change
        The same on axes orthogonal, as shapes, to Blanz and Vetter's direction.
    correlation
        Of held-out people's attribute with their coefficient on its axis.
    """

    per_deviation: float
    largest_change: float
    mean_change: float
    blanz_vetter_change: float
    correlation: float


def attribute_figures(
    model: BodyModel,
    attribute: MeasuredAttribute,
    coefficients: Float[np.ndarray, "s n"],
) -> AttributeFigures:
    """Turn a model to an attribute and measure what the other axes still change of it.

    ``coefficients`` are the held-out people's in the model's shape space.
    """
    measured = attribute.of_model(model)
    turn = attribute_space(model, measured, coefficients).turn

    def in_new_basis(shape: np.ndarray) -> float:
        return measured(turn @ shape)

    axes = np.eye(len(turn))
    changes = attribute_changes(in_new_basis, list(axes[1:]), SOLVED_AT_DEVIATIONS)
    ends = [in_new_basis(sign * SOLVED_AT_DEVIATIONS * axes[0]) for sign in (1.0, -1.0)]
    on_axis = (coefficients @ turn)[:, 0]
    return AttributeFigures(
        per_deviation=(ends[0] - ends[1]) / (2.0 * SOLVED_AT_DEVIATIONS),
        largest_change=float(changes.max()),
        mean_change=float(changes.mean()),
        blanz_vetter_change=blanz_vetter_leak(
            measured, coefficients, attribute.of_people, gram_of_axes(model)
        ),
        correlation=float(np.corrcoef(attribute.of_people, on_axis)[0, 1]),
    )


def attribute_lines(reported: Reported) -> tuple[str, ...]:
    """The table of all attributes."""
    model = reported.model
    coefficients = shape_coefficients(model, reported.bodies.rest)
    rows = []
    for attribute in _attributes(model, reported.bodies):
        figures = attribute_figures(model, attribute, coefficients)
        rows.append(
            (
                attribute.name,
                attribute.unit,
                f"{figures.per_deviation:.2f}",
                f"{figures.largest_change:.3f}",
                f"{figures.mean_change:.3f}",
                f"{figures.blanz_vetter_change:.2f}",
                f"{figures.correlation:.4f}",
            )
        )
    heads = (
        "attribute",
        "unit",
        "per sd of its axis",
        "other axes, largest",
        "mean",
        "Blanz-Vetter, largest",
        "correlation",
    )
    return (
        *table_lines("attribute-preserving axes (section 4), changes at 3 sd", heads, rows),
        *note_lines(
            "Each attribute is given an axis of its own in turn. Stature is linear in the shape, "
            "so it stays; volume, girths and ways over the skin are curved, and what other axes "
            "change of them is their curvature, the same at both ends of an axis. "
            "Correlation: of held-out people with their coefficient on the axis."
        ),
    )


def _attributes(model: BodyModel, bodies: RegisteredBodies) -> tuple[MeasuredAttribute, ...]:
    statures = [
        stature_m(bodies.posed(subject, model.standing_pose), model.landmarks)
        for subject in range(len(bodies.rest))
    ]
    return (
        MeasuredAttribute(
            name="stature",
            unit="mm",
            of_model=lambda model: _scaled(height_attribute(model), 1000.0),
            of_people=1000.0 * np.array(statures),
        ),
        _measured(model, bodies, "weight", "kg", 1.0),
        _measured(model, bodies, "waist_girth_navel", "mm", MILLIMETRES_PER_CENTIMETRE),
        *(_surface_length(model, bodies, start, end) for start, end in SURFACE_WAYS),
    )


def _measured(
    model: BodyModel, bodies: RegisteredBodies, name: str, unit: str, scale: float
) -> MeasuredAttribute:
    exact = bodies_as_axes(model, bodies.rest)
    of_body = measurement_attribute(exact, name)
    return MeasuredAttribute(
        name=name,
        unit=unit,
        of_model=lambda model: _scaled(measurement_attribute(model, name), scale),
        of_people=scale * np.array([of_body(axis) for axis in np.eye(len(bodies.rest))]),
    )


def _surface_length(
    model: BodyModel, bodies: RegisteredBodies, start: str, end: str
) -> MeasuredAttribute:
    path = path_between_landmarks(model, start, end)
    return MeasuredAttribute(
        name=f"over the skin, {start} to {end}",
        unit="mm",
        of_model=lambda model: _scaled(
            surface_length_attribute(model, path), MILLIMETRES_PER_CENTIMETRE
        ),
        of_people=1000.0 * np.array([path.length_m(body) for body in bodies.rest]),
    )


def _scaled(attribute: Attribute, factor: float) -> Attribute:
    return lambda shape: factor * attribute(shape)
