"""A picture of a known body under a known light, made with the model that will read it.

Good for testing optimisers, which must come back to what they are given; it says nothing of
accuracy on people, for which tests/accuracy has other bodies and another renderer.
"""

from dataclasses import dataclass

import numpy as np

from fitter.arrays import Image
from fitter.body.model import regress
from fitter.body.pose_prior import mean_pose
from fitter.body.scape import increment
from fitter.energies.edges import edge_cost_map
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.landmarks import click_evidence
from fitter.energies.objective import Candidate, JointObjective, Objective
from fitter.energies.scales import NEAR_BOUNDARY_ETA_M, scales_at
from fitter.energies.shading import IntensityMap, intensity_map
from fitter.energies.shape_terms import NOTHING_KNOWN, KnownAttributes, population_prior
from fitter.energies.terms import PictureEvidence
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.fits.equipment import prepared_model
from fitter.numerics.rotations import compose
from fitter.observation.pixels import display_from_linear
from fitter.optimizer.alternation import (
    SMOOTHNESS_SCHEDULE,
    ShadedFit,
    first_shading,
    fit_shading,
    shaded_fit,
)
from fitter.optimizer.search import BodySearch
from fitter.parameters import BodyParameters, Light, Reflectance
from fitter.render.camera import Camera
from fitter.render.rasterizer import render, shade_image
from fitter.render.reflectance import shade
from fitter.request import Click
from fitter.vocabulary.choices import Gender, LightKind

CAMERA = Camera(focal_length_px=700.0, centre_x=180.0, centre_y=240.0, width=360, height=480)
LIGHT = Light(kind=LightKind.POINT, azimuth=0.7, elevation=0.5, distance=2.5)
CLICKED = tuple(
    f"{side}_{joint}"
    for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle")
    for side in ("left", "right")
)
DEPTH_M = 2.9


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class RenderedScene:
    """The truth, a start near it, and what the fit sees."""

    truth: BodyParameters
    start: BodyParameters
    operators: FittingOperators
    objective: Objective
    intensity: IntensityMap
    display: Image

    @property
    def person(self) -> JointObjective:
        """The energy of the man in this picture alone."""
        return of_person(self.objective)

    def posed_error_mm(self, parameters: BodyParameters) -> float:
        """Mean distance of vertices from the truth, with the depth of the whole body left out."""
        evaluator = self.operators.evaluator
        difference = evaluator.vertices(parameters) - evaluator.vertices(self.truth)
        return 1000 * float(np.linalg.norm(difference - difference.mean(axis=0), axis=1).mean())

    def shape_error_mm(self, parameters: BodyParameters) -> float:
        """Mean distance of vertices at rest."""
        basis = self.operators.model.shape_basis
        difference = np.tensordot(parameters.shape - self.truth.shape, basis, axes=1)
        return 1000 * float(np.linalg.norm(difference - difference.mean(axis=0), axis=1).mean())


def of_person(
    *objectives: Objective, weight: float = 1.0, attributes: KnownAttributes = NOTHING_KNOWN
) -> JointObjective:
    """The energy of one person in these pictures."""
    n = len(objectives[0].operators.model.shape_basis)
    return JointObjective(
        views=objectives, weight=weight, shape_prior=population_prior(n), attributes=attributes
    )


def rendered_scene(
    seed: int, light: Light = LIGHT, *, shape_seed: int | None = None, turned: float = 0.0
) -> RenderedScene:
    """A standing man of random shape near the mean pose, under a lamp and in ambient light.

    Scenes of one ``shape_seed`` show the same man; ``turned`` is about his own axis, radians.
    """
    rng = np.random.default_rng(seed)
    operators = prepared_model(Gender.MALE).operators
    model, evaluator = operators.model, operators.evaluator
    p, n = len(model.part_names), len(model.shape_basis)
    pose = mean_pose(operators.pose_prior) + 0.06 * rng.standard_normal((p, 3))
    pose[0] = compose(np.array([[0.0, turned, 0.0]]), pose[:1])[0]
    shape = np.concatenate([[0.0], rng.standard_normal(n - 1)])
    if shape_seed is not None:
        shape[1:] = np.random.default_rng([shape_seed, 1]).standard_normal(n - 1)
    truth = BodyParameters(pose=pose, translation=np.array([0.0, 0.0, DEPTH_M]), shape=shape)
    start = increment(
        BodyParameters(pose=pose, translation=truth.translation, shape=np.zeros(n)),
        pose=0.05 * rng.standard_normal((p, 3)),
        translation=np.array([0.01, 0.01, 0.04]) * rng.standard_normal(3),
        shape=np.zeros(n),
    )
    vertices = evaluator.vertices(truth)
    rendering = render(vertices, model.triangles, CAMERA)
    values = shade(
        vertices,
        rendering.vertex_normals,
        light=light,
        body_centre=truth.translation,
        reflectance=Reflectance(
            albedo=np.full(len(vertices), 0.5),
            specularity=np.full(len(vertices), 0.08),
            ambient=0.06,
            specular_exponent=12.0,
        ),
    )
    mask = rendering.silhouette
    luminance = np.where(mask, np.nan_to_num(shade_image(rendering, values)), 0.0)
    luminance = np.clip(luminance + 0.004 * rng.standard_normal(mask.shape), 0.0, 1.0)
    display = np.repeat(display_from_linear(luminance)[..., None], 3, axis=2).astype(np.float32)
    landmarks = CAMERA.project(regress(model.landmarks, vertices))
    clicks = {
        name: Click(x=float(x), y=float(y))
        for name in CLICKED
        for x, y in [landmarks[model.landmarks.names.index(name)] + 2.0 * rng.standard_normal(2)]
    }
    objective = Objective(
        operators=operators,
        evidence=PictureEvidence(
            camera=CAMERA,
            clicks=click_evidence(model.landmarks, clicks),
            silhouette=silhouette_evidence(mask),
            edges=edge_cost_map(display, threshold_px=8.0),
            shading=None,
        ),
        scales=scales_at(CAMERA, DEPTH_M, boundary_eta_m=2 * NEAR_BOUNDARY_ETA_M),
    )
    return RenderedScene(
        truth=truth,
        start=start,
        operators=operators,
        objective=objective,
        intensity=intensity_map(luminance.astype(np.float32), display, mask),
        display=display,
    )


def lit_fit(
    scene: RenderedScene,
    start: Candidate,
    search: BodySearch,
    lights: tuple[Light, ...],
    intensity: IntensityMap | None = None,
) -> tuple[Candidate, ShadedFit] | None:
    """Section 5 from a body: the final one, and its light; None where shading tells nothing."""
    seen = scene.intensity if intensity is None else intensity
    state = first_shading(scene.objective, start, seen, lights)
    if state is None:
        return None
    begun = scene.person.evaluate([start])
    rounds = [(smoothness, search) for smoothness in SMOOTHNESS_SCHEDULE]
    found = fit_shading(scene.person, begun, [state], rounds)
    (final,), (last,) = found.minimum.candidate.views, found.states
    assert last is not None
    return final, shaded_fit(scene.objective, final, last)
