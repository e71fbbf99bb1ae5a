"""A picture of the synthetic bar with known body and light, and the objective that reads it."""

from dataclasses import dataclass

import numpy as np

from fitter.body.model import SparseRows
from fitter.body.skeleton import regress
from fitter.camera import Camera
from fitter.energies.clicks import ClickEvidence
from fitter.energies.instruments import BodyInstruments, body_instruments
from fitter.energies.objective import Objective, PictureEvidence
from fitter.energies.scales import FAR_BOUNDARY_ETA_M, scales_at
from fitter.evidence.edge_cost import edge_cost_map
from fitter.evidence.intensity import IntensityMap, intensity_map
from fitter.evidence.silhouette_evidence import silhouette_evidence
from fitter.parameters import BodyParameters, Light, LightKind, Reflectance
from fitter.render.interpolation import shade_image
from fitter.render.rasterizer import render
from fitter.render.reflectance import shade
from tests.unit.body.synthetic_model import bar_model

CAMERA = Camera(focal_length_px=600.0, centre_x=200.0, centre_y=200.0, width=400, height=400)
TRUTH = BodyParameters(
    pose=np.array([[0.1, 0.4, 0.05], [0.25, 0.0, 0.2], [-0.2, 0.1, -0.25]]),
    translation=np.array([0.02, 0.55, 2.6]),
    shape=np.array([0.0, 1.0]),
)
LIGHT = Light(kind=LightKind.POINT, azimuth=0.7, elevation=0.4, distance=2.5)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BarScene:
    instruments: BodyInstruments
    objective: Objective
    intensity: IntensityMap


def bar_scene() -> BarScene:
    """Render the truth: mask, clicks at ring centres, lit picture on black."""
    model = bar_model(rings=37, sides=24)
    instruments = body_instruments(model)
    vertices = instruments.evaluator.vertices(TRUTH)
    rendering = render(vertices, model.triangles, CAMERA)
    reflectance = Reflectance(
        albedo=np.full(len(vertices), 0.5),
        specularity=np.full(len(vertices), 0.05),
        ambient=0.08,
        specular_exponent=12.0,
    )
    shading = shade(
        vertices,
        rendering.vertex_normals,
        light=LIGHT,
        body_centre=TRUTH.translation,
        reflectance=reflectance,
    )
    luminance = np.nan_to_num(shade_image(rendering, shading)).astype(np.float32)
    luminance *= rendering.silhouette
    display = np.repeat((luminance.clip(0, 1) ** (1 / 2.2))[..., None], 3, axis=2)
    rings = [np.arange(24 * r, 24 * r + 24) for r in (0, 12, 24, 36)]
    rows = SparseRows(
        names=("a", "b", "c", "d"),
        pointers=24 * np.arange(5),
        indices=np.concatenate(rings),
        weights=np.full(96, 1.0 / 24),
    )
    objective = Objective(
        instruments=instruments,
        evidence=PictureEvidence(
            camera=CAMERA,
            clicks=ClickEvidence(
                landmarks=rows,
                clicks=CAMERA.project(regress(rows, vertices)),
                confidence=np.ones(4),
            ),
            silhouette=silhouette_evidence(rendering.silhouette),
            edges=edge_cost_map(display, threshold_px=10.0),
            shading=None,
        ),
        scales=scales_at(CAMERA, TRUTH.translation[2], boundary_eta_m=FAR_BOUNDARY_ETA_M),
    )
    return BarScene(
        instruments=instruments,
        objective=objective,
        intensity=intensity_map(luminance, display, rendering.silhouette),
    )
