"""Errors of a body model on people, and in poses, that it has not seen."""

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Pose, Shape, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import standing_vertices, stature_m
from fitter.numerics.meshes import vertex_areas
from fitter.parameters import BodyParameters
from fitter.training.articulation.joints import joint_errors_mm
from fitter.training.articulation.poses import random_pose
from fitter.training.articulation.rigged_bodies import RegisteredBodies
from fitter.training.assemble import height_attribute
from fitter.training.shapes.height_rotation import SOLVED_AT_DEVIATIONS, attribute_changes
from fitter.training.shapes.principal_shapes import centred, project, vertex_masses

POSED_EXAMPLES = 200
_SEED = 20090929
"""Seed of the held-out poses; training draws its own from the build's seed."""


class VertexError(NamedTuple):
    """Mean distance of vertices after the best translation, millimetres.

    ``by_vertex`` counts every vertex once, as such figures usually do; 69 % of them lie in head,
    hands and feet. ``by_area`` counts every square centimetre of skin once.
    """

    by_vertex: float
    by_area: float


class PosedBody(NamedTuple):
    """A body in a pose: its shape in some model, the pose, and where its vertices truly are."""

    shape: Shape
    pose: Pose
    vertices: Vertices


def held_out_figures(model: BodyModel, bodies: RegisteredBodies) -> dict[str, float | int]:
    """The figures by the names that the model file's header keeps; the same every time."""
    shape = shape_error(model, bodies.rest)
    coefficients = shape_coefficients(model, bodies.rest)
    # Whole bodies in place of the shape basis: then the error is that of the articulation alone.
    exact, each = bodies_as_axes(model, bodies.rest), np.eye(len(bodies.rest))
    posed = posed_error(exact, _random_bodies(bodies, each))
    rigid = posed_error(without_pose_term(exact), _random_bodies(bodies, each))
    rebuilt = posed_error(model, _random_bodies(bodies, coefficients))
    joints = joint_errors_mm(model.joint_regressor, bodies.rest, bodies.joints)
    statures = [
        stature_m(bodies.posed(subject, model.standing_pose), model.landmarks)
        for subject in range(len(bodies.rest))
    ]
    return {
        "subjects": len(bodies.rest),
        "shape_mm": shape.by_vertex,
        "shape_by_area_mm": shape.by_area,
        **height_figures(model),
        "height_correlation": float(np.corrcoef(statures, coefficients[:, 0])[0, 1]),
        "posed_mm": posed.by_vertex,
        "posed_by_area_mm": posed.by_area,
        "posed_rigid_parts_only_mm": rigid.by_vertex,
        "shaped_and_posed_mm": rebuilt.by_vertex,
        "joints_mm": float(np.mean(joints)),
        "worst_joint_mm": float(joints.max()),
    }


def height_figures(model: BodyModel) -> dict[str, float]:
    """Figures of how well one axis carries height, millimetres.

    The largest change of stature, and of the whole mesh's extent, three standard deviations out
    along any other axis, and what one deviation of its own axis adds to stature.
    """
    height, evaluator = height_attribute(model), ScapeEvaluator(model)

    def extent(shape: Shape) -> float:
        return float(np.ptp(standing_vertices(evaluator, shape)[:, 1]))

    axes = np.eye(len(model.shape_basis))
    others = list(axes[1:])
    changes, extents = (
        float((1000.0 * attribute_changes(attribute, others, SOLVED_AT_DEVIATIONS)).max())
        for attribute in (height, extent)
    )
    return {
        "height_change_at_3_deviations_mm": changes,
        "extent_change_at_3_deviations_mm": extents,
        "height_per_deviation_mm": 500.0 * (height(axes[0]) - height(-axes[0])),
    }


def vertex_error(residuals: Float[np.ndarray, "k m 3"], areas: PerVertex) -> VertexError:
    """Mean length of residuals (metres) after the best translation, counted both ways."""
    by_vertex, by_area = (
        1000.0
        * np.average(
            np.linalg.norm(centred(residuals, weights), axis=2).mean(axis=0), weights=weights
        )
        for weights in (np.ones_like(areas), areas)
    )
    return VertexError(by_vertex=float(by_vertex), by_area=float(by_area))


def mean_areas(model: BodyModel) -> PerVertex:
    """Area of skin about each vertex of the mean body, square metres."""
    return vertex_areas(model.mean_vertices, model.triangles)


def shape_coefficients(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"]
) -> Float[np.ndarray, "s n"]:
    """Best coefficients of bodies at rest."""
    return _projected(model, rest)[0]


def shape_residuals(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"]
) -> Float[np.ndarray, "s m 3"]:
    """Bodies minus what n coefficients rebuild of them, metres, mass centres together."""
    return _projected(model, rest)[1]


def shape_error(model: BodyModel, rest: Float[np.ndarray, "s m 3"]) -> VertexError:
    """Error of bodies rebuilt from their n coefficients."""
    return vertex_error(shape_residuals(model, rest), mean_areas(model))


def bodies_as_axes(model: BodyModel, rest: Float[np.ndarray, "s m 3"]) -> BodyModel:
    """The model with whole bodies in place of its shape axes: coefficients e_k are body k exactly.

    How strongly joints act on each body follows from its coefficients in the model's shape space.
    """
    coefficients = shape_coefficients(model, rest)
    return replace(
        model,
        shape_basis=rest - model.mean_vertices,
        pose_feature_strengths=model.pose_feature_strengths @ coefficients.T,
    )


def without_pose_term(model: BodyModel) -> BodyModel:
    """The model with rigid parts alone."""
    return replace(model, pose_right_hand_sides=np.zeros_like(model.pose_right_hand_sides))


def posed_error(model: BodyModel, posed: Iterable[PosedBody]) -> VertexError:
    """Error of a model on posed bodies, the translation of the whole body free."""
    evaluator = ScapeEvaluator(model)
    residuals = [
        evaluator.body_frame_vertices(
            BodyParameters(pose=each.pose, translation=np.zeros(3), shape=each.shape)
        )
        - each.vertices
        for each in posed
    ]
    return vertex_error(np.stack(residuals), mean_areas(model))


def _random_bodies(
    bodies: RegisteredBodies, shapes: Float[np.ndarray, "s n"]
) -> Iterable[PosedBody]:
    """Every body in turn in random poses, the same ones every time."""
    rng = np.random.default_rng(_SEED)
    for k in range(POSED_EXAMPLES):
        subject, pose = k % len(shapes), random_pose(rng)
        yield PosedBody(shape=shapes[subject], pose=pose, vertices=bodies.posed(subject, pose))


def _projected(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"]
) -> tuple[Float[np.ndarray, "s n"], Float[np.ndarray, "s m 3"]]:
    masses = vertex_masses(model.mean_vertices, model.triangles)
    return project(rest, masses, model.mean_vertices, model.shape_basis)
