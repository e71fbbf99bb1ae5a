"""Solve for the body that has a subject's measurements: damped Gauss-Newton with bounds.

Minimises Σ ((measured - wanted) / tolerance)² + Σ ((parameter - centre) / spread)². The prior's
centre is drawn per subject, so that what no measurement decides varies from body to body.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import no_type_check

import numpy as np
from jaxtyping import Float, Integer
from numba import njit

from fitter.arrays import Vertices
from fitter.numerics.damped_descent import Offer, Step, damped_steps, descend
from fitter.training.makehuman.body_space import BodySpace, Traits, target_coefficients
from fitter.training.surveys.survey_measurements import MEASUREMENTS, LinearForms


@no_type_check
@njit(cache=True)
def add_targets(base, targets, chosen, coefficients):
    """``base`` (m, 3) plus the chosen rows of ``targets`` (k, m, 3) times their coefficients."""
    body = base.copy()
    flat = body.reshape(-1)
    for target in chosen:
        coefficient = coefficients[target]
        displacement = targets[target].reshape(-1)
        for k in range(flat.size):
            flat[k] += coefficient * displacement[k]
    return body


@no_type_check
@njit(cache=True, fastmath=True)
def pulls_on_targets(pull, targets, chosen):
    """Inner products of ``pull`` (m, 3) with the chosen rows of ``targets`` (k, m, 3)."""
    found = np.empty(len(chosen))
    flat = pull.reshape(-1)
    for row, target in enumerate(chosen):
        displacement = targets[target].reshape(-1)
        total = 0.0
        for k in range(flat.size):
            total += flat[k] * displacement[k]
        found[row] = total
    return found


@no_type_check
@njit(cache=True)
def volume_and_pull(vertices, triangles):
    """Enclosed volume and its derivative by every vertex (m, 3)."""
    pull = np.zeros_like(vertices)
    volume = 0.0
    for triangle in range(len(triangles)):
        a, b, c = triangles[triangle]
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            across = vertices[b, u] * vertices[c, v] - vertices[b, v] * vertices[c, u]
            volume += vertices[a, axis] * across / 6.0
            pull[a, axis] += across / 6.0
            pull[b, axis] += (
                vertices[c, u] * vertices[a, v] - vertices[c, v] * vertices[a, u]
            ) / 6.0
            pull[c, axis] += (
                vertices[a, u] * vertices[b, v] - vertices[a, v] * vertices[b, u]
            ) / 6.0
    return volume, pull


DENSITY_KG_PER_M3 = 1000.0
"""Density of the whole body (section 6 takes that of water)."""

MAX_EVALUATIONS = 40
RELATIVE_DECREASE = 1e-4
"""Decrease of the cost, relative: see :func:`fitter.numerics.damped_descent.descend`."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Wanted:
    """A subject to be built.

    ``measurements`` and ``tolerance`` (q,) are in the order of :data:`MEASUREMENTS`, metres and
    kilograms; ``centre`` and ``spread`` (parameters,) are the prior's.
    """

    measurements: Float[np.ndarray, " q"]
    tolerance: Float[np.ndarray, " q"]
    centre: Float[np.ndarray, " p"]
    spread: Float[np.ndarray, " p"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Placed:
    """A body space with cuts placed: linear forms before and by target.

    Attributes
    ----------
    forms
        The placement.
    constant
        (s, 3) the forms' differences on the base mesh.
    by_target
        (k, s, 3) their change by each target's coefficient.
    body_base, body_targets
        (m, 3) and (k, m, 3) the body's vertices alike, for its volume.
    """

    space: BodySpace
    traits: Traits
    forms: LinearForms
    constant: Float[np.ndarray, "s 3"]
    by_target: Float[np.ndarray, "k s 3"]
    body_base: Vertices
    body_targets: Float[np.ndarray, "k m 3"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Linearised:
    parameters: Float[np.ndarray, " p"]
    residuals: Float[np.ndarray, " r"]
    jacobian: Float[np.ndarray, "r p"]

    @property
    def total(self) -> float:
        return 0.5 * float(self.residuals @ self.residuals)


def place(
    space: BodySpace,
    traits: Traits,
    forms: LinearForms,
    body_targets: Float[np.ndarray, "k m 3"],
) -> Placed:
    """Apply the forms to the base mesh and to every target.

    ``body_targets`` are the rows of the space's targets that belong to the body, made once.
    """
    used: Integer[np.ndarray, " u"] = np.unique(forms.differences.indices)
    reduced = forms.differences[:, used]
    targets = space.targets[:, used].transpose(1, 0, 2)
    by_target = (reduced @ targets.reshape(len(used), -1)).reshape(-1, *targets.shape[1:])
    return Placed(
        space=space,
        traits=traits,
        forms=forms,
        constant=reduced @ space.base.source_vertices[used],
        by_target=np.ascontiguousarray(by_target.transpose(1, 0, 2), dtype=np.float64),
        body_base=space.base.body(space.base.source_vertices),
        body_targets=body_targets,
    )


def fit_subject(
    placed: Placed, wanted: Wanted, start: Float[np.ndarray, " p"]
) -> Float[np.ndarray, " p"]:
    """Parameters of the body nearest to what is wanted, within the space's bounds."""
    lower, upper = placed.space.lower, placed.space.upper

    def paraboloid(now: _Linearised) -> Callable[[float], Offer[_Linearised]]:
        gradient = now.jacobian.T @ now.residuals
        # A parameter at its bound that the descent pushes outwards stays there for this step.
        held = (now.parameters <= lower) & (gradient > 0.0)
        held |= (now.parameters >= upper) & (gradient < 0.0)
        free = np.flatnonzero(~held)

        def taken(step: Step) -> _Linearised:
            reached = now.parameters.copy()
            reached[free] += step
            return _linearise(placed, wanted, np.clip(reached, lower, upper))

        slopes = now.jacobian[:, free]
        return damped_steps(slopes.T @ slopes, gradient[free], taken, floor=0.0)

    return descend(
        _linearise(placed, wanted, np.clip(start, lower, upper)),
        paraboloid,
        max_evaluations=MAX_EVALUATIONS,
        settled=0.0,
        settled_share=RELATIVE_DECREASE,
    ).point.parameters


def measured(
    placed: Placed, parameters: Float[np.ndarray, " p"]
) -> tuple[Float[np.ndarray, " q"], Float[np.ndarray, "q p"]]:
    """All measurements of a body and their derivatives by the parameters."""
    coefficients, by_parameter = target_coefficients(placed.space, placed.traits, parameters)
    active = np.flatnonzero(coefficients)
    moving = np.flatnonzero(by_parameter.any(axis=1))
    differences = placed.constant + np.tensordot(
        coefficients[active], placed.by_target[active], axes=1
    )
    forms = placed.forms
    lengths = np.linalg.norm(differences, axis=1)
    direction = np.eye(3)[np.maximum(forms.axis, 0)]
    by_length = forms.axis < 0
    direction[by_length] = differences[by_length] / lengths[by_length, None]
    terms = np.einsum("sx,sx->s", direction, differences)
    slopes = np.einsum("ksx,sx->sk", placed.by_target[moving], direction)
    count = len(MEASUREMENTS)
    values = np.bincount(forms.measurement, terms, minlength=count)
    # Adds the terms of each measurement.
    total = np.equal.outer(np.arange(count), forms.measurement).astype(np.float64)
    by_target = total @ slopes
    body = add_targets(placed.body_base, placed.body_targets, active, coefficients)
    volume, pull = volume_and_pull(body, placed.space.base.triangles)
    values[-1] = DENSITY_KG_PER_M3 * volume
    by_target[-1] = DENSITY_KG_PER_M3 * pulls_on_targets(
        pull.astype(np.float32), placed.body_targets, moving
    )
    return values, by_target @ by_parameter[moving]


def _linearise(placed: Placed, wanted: Wanted, parameters: Float[np.ndarray, " p"]) -> _Linearised:
    values, derivative = measured(placed, parameters)
    return _Linearised(
        parameters=parameters,
        residuals=np.concatenate(
            [
                (values - wanted.measurements) / wanted.tolerance,
                (parameters - wanted.centre) / wanted.spread,
            ]
        ),
        jacobian=np.concatenate(
            [derivative / wanted.tolerance[:, None], np.diag(1.0 / wanted.spread)]
        ),
    )
