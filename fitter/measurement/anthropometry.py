"""Measure a body: canonical pose, plane cut, convex hull, volume (section 6).

In a fixed pose SCAPE's vertices are affine in the shape, so a body is measured without evaluating
the model again, and derivatives by shape cost only tape measurements.

A model's header says so of what was measured when it was trained. Of measurements defined since
then ``unexplained.json`` beside this file says it of the packaged models, by their checksums; the
command ``python -m fitter.training report --unexplained FILE`` writes it.
"""

import json
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Pose, Shape, Triangles, Vertices
from fitter.body.model import BodyModel, SparseRows, regress
from fitter.body.scape import ScapeEvaluator
from fitter.errors import DefinitionError, NumericalError
from fitter.measurement.definitions import (
    JOINT_PREFIX,
    Mass,
    Measurement,
    MeasurementDefinition,
    load_definitions,
    parts_of,
    points_of,
)
from fitter.measurement.held_tapes import HeldTapes, MovedBodies, held_values, hold_tapes
from fitter.measurement.plane_cut import Region, restricted, whole_mesh
from fitter.measurement.skin_points import load_skin_points, skin_rows
from fitter.measurement.taking import (
    TakenBody,
    girth_placements,
    girths_of,
    lay_tapes,
    taken_line,
    taken_values,
)
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class AffineBody:
    """A body in one fixed pose as a function of its shape, body frame, metres.

    ``derivative`` has one (m, 3) displacement per coefficient.
    """

    mean: Vertices
    derivative: Float[np.ndarray, "n m 3"]

    def at(self, shape: Shape) -> Vertices:
        """Vertices of the body with this shape."""
        return self.mean + np.tensordot(shape, self.derivative, axes=1)


def affine_body(evaluator: ScapeEvaluator, pose: Pose) -> AffineBody:
    """The body in a fixed pose as an affine function of shape, root joint at the origin.

    Exact: the SCAPE normal equations have a fixed matrix and, the pose being fixed, a right-hand
    side that is affine in the shape.
    """
    n = len(evaluator.model.shape_basis)

    def evaluate(shape: Shape) -> Vertices:
        return evaluator.body_frame_vertices(
            BodyParameters(pose=pose, translation=np.zeros(3), shape=shape)
        )

    mean = evaluate(np.zeros(n))
    return AffineBody(mean=mean, derivative=np.stack([evaluate(e) - mean for e in np.eye(n)]))


UNEXPLAINED_KEY = "unexplained_measurements"
"""Field of a model's header."""

UNEXPLAINED_PATH = Path(__file__).with_name("unexplained.json")


def unexplained(model: BodyModel, names: Sequence[str]) -> Float[np.ndarray, " k"]:
    """One standard deviation of each, in its unit.

    Zero where nothing is said, as for models without people to test on.
    """
    said = model.header.get(UNEXPLAINED_KEY)
    by_name = _since().get(model.checksum, {}) | (dict(said) if isinstance(said, Mapping) else {})
    return np.array([float(by_name.get(name, 0.0)) for name in names])


@cache
def _since(path: Path = UNEXPLAINED_PATH) -> Mapping[str, dict[str, float]]:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        message = f"{path.name} cannot be read as JSON ({error})."
        raise DefinitionError(message) from error


DIFFERENCE_STEP = 1e-3
"""Standard deviations. Girths are smooth but for corners joining or leaving the hull, whose effect
is of second order; a change of 1e-3 moves a girth by about 0.05 mm, far above rounding."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeasuringBody:
    """A body model prepared for measuring; one per model, shared by all fits.

    Attributes
    ----------
    definitions
        What is measured.
    triangles
        (f, 3) of the mesh.
    regions
        Where the tape of each measurement with parts may run, by its name.
    canonical
        The body in the canonical pose.
    points
        Rows of landmarks, then of joints and of places of the skin, which have prefixes to their
        names.
    canonical_points, standing_points
        Those points in the canonical and in the standing pose.
    unexplained
        (k,) how much people differ in each measurement from the nearest body of the model, one
        standard deviation: what no fit can know of them.
    """

    definitions: tuple[MeasurementDefinition, ...]
    triangles: Triangles
    regions: Mapping[str, Region]
    canonical: AffineBody
    points: SparseRows
    canonical_points: AffineBody
    standing_points: AffineBody
    unexplained: Float[np.ndarray, " k"]


def measuring_body(
    model: BodyModel,
    evaluator: ScapeEvaluator,
    definitions: Sequence[MeasurementDefinition] | None = None,
) -> MeasuringBody:
    """Prepare a model for measuring: some forty evaluations, once.

    Raises
    ------
    DefinitionError
        If a place of the skin is not on the model.
    """
    definitions = load_definitions() if definitions is None else tuple(definitions)
    canonical = affine_body(evaluator, model.canonical_pose)
    everything = whole_mesh(model.triangles)
    with_girths = {d.about.name: d for d in definitions} | dict(girths_of(definitions))
    regions = {
        name: restricted(everything, _part_shares(model, parts))
        for name, definition in with_girths.items()
        if (parts := parts_of(definition))
    }
    points = _point_rows(model, definitions, canonical.mean)
    return MeasuringBody(
        definitions=definitions,
        triangles=model.triangles,
        regions=regions,
        canonical=canonical,
        points=points,
        canonical_points=_points(points, canonical),
        standing_points=_points(points, affine_body(evaluator, model.standing_pose)),
        unexplained=unexplained(model, [definition.about.name for definition in definitions]),
    )


def measure(
    body: MeasuringBody,
    shape: Shape,
    *,
    shape_covariance: Float[np.ndarray, "n n"] | None = None,
    given: Collection[str] = (),
    held: Collection[str] = (),
) -> tuple[Measurement, ...]:
    """All measurements of the body with this shape.

    Parameters
    ----------
    body
        From :func:`measuring_body`.
    shape
        (n,) coefficients, standard deviations.
    shape_covariance
        Covariance of ``shape`` at the final body; gives every measurement J Σ Jᵀ as its variance,
        and what the shapes leave unexplained besides.
    given
        Names of measurements that were given, not inferred: nothing about them is unexplained.
    held
        Names of measurements that every body under consideration has exactly: they do not vary.
        J Σ Jᵀ would leave them what rounding leaves of the directions that keep them.

    Raises
    ------
    NumericalError
        If a measurement is not finite.
    """
    taken = _take(body, shape)
    placements = girth_placements(body.definitions, taken)
    laid = lay_tapes(body.definitions, taken, placements)
    values = taken_values(body.definitions, taken, laid)
    if not np.isfinite(values).all():
        names = [d.about.name for d, v in zip(body.definitions, values, strict=True) if v != v]
        message = f"Not finite: {', '.join(names)} at shape {shape}."
        raise NumericalError(message)
    errors: Sequence[float | None] = [None] * len(values)
    if shape_covariance is not None:
        jacobian = _forward_jacobian(
            body,
            shape,
            HeldTapes(definitions=body.definitions, taken=taken, placements=placements, laid=laid),
            values,
        )
        variances = np.einsum("kn,nj,kj->k", jacobian, shape_covariance, jacobian)
        inferred = [each.about.name not in given for each in body.definitions]
        variances += np.where(inferred, body.unexplained**2, 0.0)
        variances[[each.about.name in held for each in body.definitions]] = 0.0
        errors = [float(e) for e in np.sqrt(np.maximum(variances, 0.0))]
    return tuple(
        Measurement(
            name=definition.about.name,
            value=float(value),
            unit=definition.about.unit,
            standard_error=error,
            definition=definition.about.definition,
            source=definition.about.source,
        )
        for definition, value, error in zip(body.definitions, values, errors, strict=True)
    )


def error_if_known(
    body: MeasuringBody,
    shape: Shape,
    shape_covariance: Float[np.ndarray, "n n"],
    *,
    of: str,
    known: str,
) -> float:
    """Share of a standard error that knowing another measurement exactly would leave, in (0, 1].

    For normal errors the variance of a under a known b is aΣa - (aΣb)² / bΣb; what the shapes leave
    unexplained of a stays.
    """
    names = [definition.about.name for definition in body.definitions]
    jacobian = measurement_jacobian(body, shape)[[names.index(of), names.index(known)]]
    (own, shared), (_, other) = jacobian @ shape_covariance @ jacobian.T
    unexplained = body.unexplained[names.index(of)] ** 2
    left = own - shared**2 / max(other, 1e-12)
    return float(np.sqrt((max(left, 0.0) + unexplained) / (own + unexplained)))


def measurement_values(body: MeasuringBody, shape: Shape) -> Float[np.ndarray, " k"]:
    """The measurements' values alone, in the order of ``body.definitions`` and in their units."""
    taken = _take(body, shape)
    placements = girth_placements(body.definitions, taken)
    return taken_values(body.definitions, taken, lay_tapes(body.definitions, taken, placements))


def tape_lines(body: MeasuringBody, shape: Shape) -> Mapping[str, Float[np.ndarray, "_ 3"]]:
    """Lines on the canonical body along which measurements are taken, by name.

    Lines of (k, 3) points in the body frame, metres; a girth's is closed by repeating its first
    point. A weight has none. Heights are taken in the standing pose, whose legs are straight down;
    their lines show the same points on the canonical body, so that these lines may be some
    millimetres shorter than what is measured.
    """
    taken = _take(body, shape)
    placements = girth_placements(body.definitions, taken)
    lines = {
        definition.about.name: taken_line(definition, taken, placements)
        for definition in body.definitions
        if not isinstance(definition, Mass)
    }
    return {name: line for name, line in lines.items() if len(line) and np.isfinite(line).all()}


def measurement_jacobian(body: MeasuringBody, shape: Shape) -> Float[np.ndarray, "k n"]:
    """Derivative of every measurement (rows, their units) by every shape coefficient.

    Central differences with each tape held at its place along the body: where a girth is the
    largest or smallest of many, moving the tape changes it only in second order.
    """
    taken = _take(body, shape)
    held = hold_tapes(body.definitions, taken, girth_placements(body.definitions, taken))
    ahead, behind = (
        held_values(held, _moved(body, shape, taken, step))
        for step in (DIFFERENCE_STEP, -DIFFERENCE_STEP)
    )
    return (ahead - behind) / (2.0 * DIFFERENCE_STEP)


def _forward_jacobian(
    body: MeasuringBody,
    shape: Shape,
    held: HeldTapes,
    values: Float[np.ndarray, " k"],
) -> Float[np.ndarray, "k n"]:
    """Forward differences at half the cost: standard errors agree to ten-thousandths."""
    ahead = held_values(held, _moved(body, shape, held.taken, DIFFERENCE_STEP))
    return (ahead - values[:, None]) / DIFFERENCE_STEP


def _moved(body: MeasuringBody, shape: Shape, taken: TakenBody, step: float) -> MovedBodies:
    """The bodies a step along each coefficient away."""
    names = body.points.names
    canonical, standing = (
        dict(
            zip(names, np.moveaxis(points.at(shape) + step * points.derivative, 1, 0), strict=True)
        )
        for points in (body.canonical_points, body.standing_points)
    )
    return MovedBodies(
        vertices=taken.vertices,
        displacements=body.canonical.derivative,
        step=step,
        canonical=canonical,
        standing=standing,
    )


def _part_shares(model: BodyModel, parts: Sequence[str]) -> PerVertex:
    """Share in which each vertex follows some parts, 0 to 1."""
    chosen = np.isin(model.skinning_parts, [model.part_names.index(part) for part in parts])
    weights = model.skinning_weights
    return np.where(chosen, weights, 0.0).sum(axis=1) / weights.sum(axis=1)


def _point_rows(
    model: BodyModel, definitions: Sequence[MeasurementDefinition], canonical: Vertices
) -> SparseRows:
    """Landmarks, joints and the places of the skin that definitions name, as rows of one matrix."""
    joints = replace(
        model.joint_regressor, names=tuple(JOINT_PREFIX + part for part in model.part_names)
    )
    known = _stacked(model.landmarks, joints)
    named = {name for definition in definitions for name in points_of(definition)}
    places = [place for name, place in load_skin_points().items() if name in named]
    if not places:
        return known
    at = dict(zip(known.names, regress(known, canonical), strict=True))
    return _stacked(known, skin_rows(places, at, canonical, model.triangles))


def _stacked(first: SparseRows, second: SparseRows) -> SparseRows:
    return SparseRows(
        names=(*first.names, *second.names),
        pointers=np.concatenate([first.pointers[:-1], second.pointers + first.pointers[-1]]),
        indices=np.concatenate([first.indices, second.indices]),
        weights=np.concatenate([first.weights, second.weights]),
    )


def _points(rows: SparseRows, posed: AffineBody) -> AffineBody:
    return AffineBody(
        mean=regress(rows, posed.mean),
        derivative=np.stack([regress(rows, column) for column in posed.derivative]),
    )


def _take(body: MeasuringBody, shape: Shape) -> TakenBody:
    names = body.points.names
    return TakenBody(
        vertices=body.canonical.at(shape),
        triangles=body.triangles,
        regions=body.regions,
        canonical=dict(zip(names, body.canonical_points.at(shape), strict=True)),
        standing=dict(zip(names, body.standing_points.at(shape), strict=True)),
    )
