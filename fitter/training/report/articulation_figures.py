"""How well a model bends: error by region, volume kept, joint centres, parts run into one another.

The learned term can be no better than what it learned from, so the volume that the rig's own bodies
keep (:mod:`fitter.training.articulation.volume_keeping`) stands beside the model's.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import islice

import numpy as np
from jaxtyping import Float

from fitter.arrays import Pose, Shape, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.energies.penetration import penetration_proxy, sphere_overlaps, sphere_positions
from fitter.numerics.meshes import enclosed_volume
from fitter.parameters import BodyParameters
from fitter.training.articulation.plausible_poses import (
    ADMITTED_DEGREES,
    model_pose_prior,
    plausible_poses,
)
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.report.body_regions import vertex_regions
from fitter.training.report.evaluation import bodies_as_axes, without_pose_term
from fitter.training.report.reported import Reported
from fitter.training.report.text_tables import note_lines, table_lines
from fitter.training.shapes.likely_bodies import random_shapes

POSES = 500
COMPARED = 100
"""Held-out bodies posed by the rig to compare with, one pose each."""

VOLUME_GOAL = 0.01
"""Share of its volume at rest that a posed body may gain or lose."""

DEEP_M = 0.02
"""Overlap of two of the penetration term's spheres that counts as a collision."""

_SEED = 20090930


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ComparedPoses:
    """A model beside the rig, on held-out bodies in plausible poses.

    Attributes
    ----------
    with_term, without_term
        Mean distance of vertices by region, millimetres, each body's shape given exactly.
    taught, learned
        (k,) gain of volume by posing, of the rig's bodies and of the model's.
    """

    with_term: Mapping[str, float]
    without_term: Mapping[str, float]
    taught: Float[np.ndarray, " k"]
    learned: Float[np.ndarray, " k"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PosedVolumes:
    """The model alone in plausible poses.

    Attributes
    ----------
    mean_body, drawn_bodies
        (k,) gain of volume by posing, of the mean body and of bodies drawn from the prior, share
        of the volume at rest.
    overlaps_m
        (k,) deepest overlap of two parts of the mean body, by the penetration term's spheres; zero
        where none touch.
    """

    mean_body: Float[np.ndarray, " k"]
    drawn_bodies: Float[np.ndarray, " k"]
    overlaps_m: Float[np.ndarray, " k"]


def compared_poses(model: BodyModel, bodies: RegisteredBodies, poses: list[Pose]) -> ComparedPoses:
    """Pose held-out bodies by the rig, by the model, and by its rigid parts alone."""
    count = len(bodies.rest)
    exact = bodies_as_axes(model, bodies.rest)
    evaluators = ScapeEvaluator(exact), ScapeEvaluator(without_pose_term(exact))
    distances = np.zeros((2, len(model.mean_vertices)))
    taught, learned = np.empty(len(poses)), np.empty(len(poses))
    for k, pose in enumerate(poses):
        shape = np.eye(count)[k % count]
        posed = bodies.posed(k % count, pose)
        found = [_posed(evaluator, shape, pose) for evaluator in evaluators]
        for row, vertices in zip(distances, found, strict=True):
            residuals = vertices - posed
            row += np.linalg.norm(residuals - residuals.mean(axis=0), axis=1)
        at_rest = enclosed_volume(bodies.rest[k % count].astype(np.float64), model.triangles)
        taught[k] = enclosed_volume(posed, model.triangles) / at_rest - 1.0
        learned[k] = enclosed_volume(found[0], model.triangles) / at_rest - 1.0
    by_vertex = 1000.0 * distances / len(poses)
    regions = {name: m for name, m in vertex_regions(model).items() if m.any()}
    with_term, without_term = (
        {name: float(row[members].mean()) for name, members in regions.items()} for row in by_vertex
    )
    return ComparedPoses(
        with_term=with_term, without_term=without_term, taught=taught, learned=learned
    )


def posed_volumes(model: BodyModel, poses: list[Pose], rng: np.random.Generator) -> PosedVolumes:
    """Pose the mean body and as many drawn ones."""
    evaluator = ScapeEvaluator(model)
    mean = np.zeros(len(model.shape_basis))
    canonical = _posed(evaluator, mean, model.canonical_pose)
    proxy = penetration_proxy(model, canonical)
    mean_body, drawn_bodies, overlaps = (np.empty(len(poses)) for _ in range(3))
    drawn = random_shapes(len(poses), len(mean), rng)
    for k, (pose, shape) in enumerate(zip(poses, drawn, strict=True)):
        vertices = _posed(evaluator, mean, pose)
        mean_body[k] = _gain(model, mean, vertices)
        drawn_bodies[k] = _gain(model, shape, _posed(evaluator, shape, pose))
        spheres, radii = sphere_positions(proxy, vertices)
        overlaps[k] = sphere_overlaps(spheres, radii, proxy.pairs).max(initial=0.0)
    return PosedVolumes(mean_body=mean_body, drawn_bodies=drawn_bodies, overlaps_m=overlaps)


def articulation_lines(reported: Reported) -> tuple[str, ...]:
    """The section of the report."""
    model = reported.model
    rng = np.random.default_rng(_SEED)
    poses = list(islice(plausible_poses(model_pose_prior(model), rng), POSES))
    compared = compared_poses(model, reported.bodies, poses[:COMPARED])
    volumes = posed_volumes(model, poses, rng)
    errors = [
        (name, f"{compared.with_term[name]:.2f}", f"{compared.without_term[name]:.2f}")
        for name in compared.with_term
    ]
    gains = [
        _volume_row("the rig's held-out bodies, as taught", compared.taught),
        _volume_row("the same bodies by the model", compared.learned),
        _volume_row("the model's mean body", volumes.mean_body),
        _volume_row("bodies drawn from the prior", volumes.drawn_bodies),
    ]
    joints = [(name, f"{error:.2f}") for name, error in _by_joint(reported.errors.joints).items()]
    heads = ("", "poses", "mean", "95th", "worst", "within 1 %")
    met = np.percentile(np.abs(volumes.drawn_bodies), 95.0) <= VOLUME_GOAL
    overlaps = 1000.0 * volumes.overlaps_m
    return (
        *table_lines(
            f"posed error by region, {len(compared.taught)} held-out bodies in plausible poses, mm",
            ("", "with the pose term", "rigid parts alone"),
            errors,
        ),
        *table_lines("volume gained or lost by posing, %", heads, gains),
        *note_lines(
            f"Plausible: random poses no joint of which is more than {ADMITTED_DEGREES:g} degrees "
            "beyond its limits. Goal: drawn bodies keep their volume within 1 % in 95 of 100 "
            f"poses: {'ok' if met else 'MISSED'}."
        ),
        *table_lines("joint centres at rest, mean distance, mm", ("", ""), joints),
        *note_lines(
            f"Parts run into one another by more than {1000.0 * DEEP_M:.0f} mm in "
            f"{100.0 * np.mean(volumes.overlaps_m > DEEP_M):.0f} % of the poses, which are drawn "
            "joint by joint and may cross limbs (mean body, spheres of the penetration term; "
            f"median of the deepest overlaps {np.median(overlaps):.0f} mm, "
            f"worst {overlaps.max():.0f} mm)."
        ),
    )


def _posed(evaluator: ScapeEvaluator, shape: Shape, pose: Pose) -> Vertices:
    return evaluator.body_frame_vertices(
        BodyParameters(pose=pose, translation=np.zeros(3), shape=shape)
    )


def _gain(model: BodyModel, shape: Shape, posed: Vertices) -> float:
    at_rest = enclosed_volume(rest_vertices(model, shape), model.triangles)
    return enclosed_volume(posed, model.triangles) / at_rest - 1.0


def _volume_row(name: str, gains: Float[np.ndarray, " k"]) -> tuple[str, ...]:
    sizes = 100.0 * np.abs(gains)
    return (
        name,
        f"{len(gains)}",
        f"{sizes.mean():.2f}",
        f"{np.percentile(sizes, 95.0):.2f}",
        f"{100.0 * gains[np.argmax(sizes)]:+.2f}",
        f"{100.0 * np.mean(np.abs(gains) <= VOLUME_GOAL):.0f} %",
    )


def _by_joint(errors: Mapping[str, float]) -> dict[str, float]:
    """Left and right as one."""
    names = {name: name.removeprefix("left_").removeprefix("right_") for name in errors}
    return {
        joint: float(np.mean([errors[name] for name, plain in names.items() if plain == joint]))
        for joint in dict.fromkeys(names.values())
    }
