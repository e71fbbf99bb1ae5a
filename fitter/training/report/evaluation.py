"""Held-out figures of a body model."""

import time
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.stature import stature_m
from fitter.parameters import BodyParameters
from fitter.training.articulation.joints import joint_errors_mm
from fitter.training.articulation.random_poses import random_pose
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.assemble import height_attribute
from fitter.training.shapes.height_rotation import attribute_changes
from fitter.training.shapes.principal_shapes import centred, project
from fitter.training.shapes.surface import vertex_areas, vertex_masses

CHECKED_AT_DEVIATIONS = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class VertexError:
    """Mean distance of vertices after the best translation, millimetres.

    ``by_vertex`` counts every vertex once, as such figures usually do; 69 % of them lie in head,
    hands and feet. ``by_area`` counts every square centimetre of skin once.
    """

    by_vertex: float
    by_area: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class HeightAxes:
    """How well one axis carries height.

    Attributes
    ----------
    changes_mm
        (n - 1,) largest change of stature at plus and minus three deviations along each
        non-height axis; ``extent_changes_mm`` the same of the mesh's full vertical extent.
    per_deviation_mm
        Stature gained by one deviation of the height axis.
    correlation
        Of held-out subjects' stature with their coefficient on the height axis.
    """

    changes_mm: Float[np.ndarray, " k"]
    extent_changes_mm: Float[np.ndarray, " k"]
    per_deviation_mm: float
    correlation: float


def vertex_error(residuals: Float[np.ndarray, "k m 3"], areas: PerVertex) -> VertexError:
    """Mean length of residuals (metres) after the best translation, counted both ways."""
    equal = np.ones_like(areas)
    by_vertex, by_area = (
        1000.0
        * np.average(
            np.linalg.norm(centred(residuals, weights), axis=2).mean(axis=0), weights=weights
        )
        for weights in (equal, areas)
    )
    return VertexError(by_vertex=float(by_vertex), by_area=float(by_area))


def shape_coefficients(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"]
) -> Float[np.ndarray, "s n"]:
    """Best coefficients of bodies at rest."""
    return _projected(model, rest)[0]


def mean_areas(model: BodyModel) -> PerVertex:
    """Area of skin about each vertex of the mean body, square metres."""
    return vertex_areas(model.mean_vertices, model.triangles)


def shape_residuals(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"]
) -> Float[np.ndarray, "s m 3"]:
    """Bodies minus what n coefficients rebuild of them, metres, mass centres together."""
    return _projected(model, rest)[1]


def shape_error(model: BodyModel, rest: Float[np.ndarray, "s m 3"]) -> VertexError:
    """Error of bodies rebuilt from their n coefficients."""
    return vertex_error(shape_residuals(model, rest), mean_areas(model))


def height_axes(model: BodyModel, bodies: RegisteredBodies) -> HeightAxes:
    """Leak of height into the other axes, and how it follows its own."""
    height = height_attribute(model)
    evaluator = ScapeEvaluator(model)

    def extent(shape: np.ndarray) -> float:
        parameters = BodyParameters(pose=model.standing_pose, translation=np.zeros(3), shape=shape)
        return float(np.ptp(evaluator.body_frame_vertices(parameters)[:, 1]))

    axes = np.eye(len(model.shape_basis))
    coefficients = shape_coefficients(model, bodies.rest)
    statures = np.array(
        [
            stature_m(bodies.posed(subject, model.standing_pose), model.landmarks)
            for subject in range(len(bodies.rest))
        ]
    )
    others = list(axes[1:])
    return HeightAxes(
        changes_mm=1000.0 * attribute_changes(height, others, CHECKED_AT_DEVIATIONS),
        extent_changes_mm=1000.0 * attribute_changes(extent, others, CHECKED_AT_DEVIATIONS),
        per_deviation_mm=500.0 * (height(axes[0]) - height(-axes[0])),
        correlation=float(np.corrcoef(statures, coefficients[:, 0])[0, 1]),
    )


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


def posed_error(
    model: BodyModel, bodies: RegisteredBodies, count: int, rng: np.random.Generator
) -> VertexError:
    """Error of held-out bodies in held-out poses, each body's shape given exactly.

    The bodies themselves take the place of the shape basis, so that the figure is that of the
    articulation alone; how strongly joints act still follows from their coefficients.
    """
    exact = bodies_as_axes(model, bodies.rest)
    return _posed_error(exact, np.eye(len(bodies.rest)), bodies, count, rng)


def shaped_and_posed_error(
    model: BodyModel, bodies: RegisteredBodies, count: int, rng: np.random.Generator
) -> VertexError:
    """The same with each body rebuilt from its n coefficients: shape and pose errors together."""
    coefficients = shape_coefficients(model, bodies.rest)
    return _posed_error(model, coefficients, bodies, count, rng)


def joint_distances(model: BodyModel, bodies: RegisteredBodies) -> dict[str, float]:
    """Mean distance of regressed from true joint centres at rest, by part, millimetres."""
    distances = joint_errors_mm(model.joint_regressor, bodies.rest, bodies.joints)
    return dict(zip(model.part_names, distances.tolist(), strict=True))


def without_pose_term(model: BodyModel) -> BodyModel:
    """The model with rigid parts alone."""
    return replace(model, pose_right_hand_sides=np.zeros_like(model.pose_right_hand_sides))


def evaluation_milliseconds(model: BodyModel, repeats: int, rng: np.random.Generator) -> float:
    """Median processor time of one evaluation, after warming up: what else runs does not count."""
    evaluator = ScapeEvaluator(model)
    drawn = [
        BodyParameters(
            pose=random_pose(rng),
            translation=np.zeros(3),
            shape=rng.normal(size=len(model.shape_basis)),
        )
        for _ in range(repeats)
    ]
    times = []
    for parameters in drawn:
        start = time.thread_time()
        evaluator.vertices(parameters)
        times.append(time.thread_time() - start)
    return 1000.0 * float(np.median(times[len(times) // 10 :]))


def _posed_error(
    model: BodyModel,
    shapes: Float[np.ndarray, "s n"],
    bodies: RegisteredBodies,
    count: int,
    rng: np.random.Generator,
) -> VertexError:
    evaluator = ScapeEvaluator(model)
    areas = mean_areas(model)
    residuals = np.empty((count, *model.mean_vertices.shape))
    for k in range(count):
        subject = k % len(shapes)
        pose = random_pose(rng)
        found = evaluator.body_frame_vertices(
            BodyParameters(pose=pose, translation=np.zeros(3), shape=shapes[subject])
        )
        residuals[k] = found - bodies.posed(subject, pose)
    return vertex_error(residuals, areas)


def _projected(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"]
) -> tuple[Float[np.ndarray, "s n"], Float[np.ndarray, "s m 3"]]:
    masses = vertex_masses(model.mean_vertices, model.triangles)
    return project(rest, masses, model.mean_vertices, model.shape_basis)
