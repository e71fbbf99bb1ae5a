"""Fig. 7: reflectance and light found again on a fitted body, with highlights and without."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from jaxtyping import Bool, Float

from fitter.arrays import PerVertex
from fitter.energies.scales import NEAR_BOUNDARY_ETA_M
from fitter.energies.shading import seen_vertices
from fitter.evidence.intensity import IntensityMap, intensity_map
from fitter.export.antialiasing import render_finely, vertex_pictures
from fitter.export.display import to_levels
from fitter.fits.picture_objective import silhouette_and_edges
from fitter.fits.pipeline import PACKAGED
from fitter.fits.prepared_model import prepared_model
from fitter.numerics.meshes import vertex_areas
from fitter.observation.observation import observe
from fitter.optimizer.alternation import (
    SMOOTHNESS_SCHEDULE,
    ShadedFit,
    first_shading,
    next_shading,
    shaded_fit,
)
from fitter.render.reflectance import shade
from fitter.reproduction.figure import Figure
from fitter.reproduction.panels import row, stacked
from fitter.request import FitRequest
from fitter.result import FitResult
from fitter.segmentation.grabcut import Segmentation

WITHOUT_HIGHLIGHTS: Final = 1e9
"""A specular exponent with which no surface shows any: Lambert's model by the same solver."""

_MOST_RESIDUAL: Final = 0.25
"""Of the median brightness: what is red."""

_UNSEEN: Final = 0.8


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Refit:
    """Eq. 1 on a body.

    Attributes
    ----------
    shaded
        Light and reflectance.
    predicted, residual
        (m,) r̂, and r̂ - r over the median brightness.
    seen
        (m,) where the picture tells r.
    areas
        (m,) that the vertices stand for.
    """

    shaded: ShadedFit
    predicted: PerVertex
    residual: PerVertex
    seen: Bool[np.ndarray, " m"]
    areas: PerVertex

    @property
    def unexplained(self) -> float:
        """Mean absolute residual over the skin that tells, share of the median brightness."""
        return float(np.average(np.abs(self.residual[self.seen]), weights=self.areas[self.seen]))


def figure_7(request: FitRequest, result: FitResult) -> Figure | None:
    """Albedo, specularity, and both models with what they leave; None without shading.

    ``result`` is of a fit of the same picture with shading.
    """
    light = result.person.light
    if light is None:
        return None
    found = [refit(request, result, exponent) for exponent in (WITHOUT_HIGHLIGHTS, None)]
    if found[0] is None or found[1] is None:
        return None
    lambertian, phong = found[0], found[1]
    reflectance = phong.shaded.reflectance
    fine = render_finely(result.found.posed_vertices, result.triangles, result.views[0].camera)
    specularity = reflectance.specularity / max(
        float(np.percentile(reflectance.specularity, 99)), 1e-6
    )
    albedo, gloss, flat, glossy, off_flat, off_glossy = vertex_pictures(
        [
            reflectance.albedo,
            specularity,
            lambertian.predicted,
            phong.predicted,
            _residual_colours(lambertian),
            _residual_colours(phong),
        ],
        fine,
    )
    grey = np.repeat(_luminance_levels(request, result)[..., None], 3, axis=2)
    return Figure(
        name="figure_7",
        title="Figure 7: estimated reflectance",
        caption=(
            "Above: the picture's brightness, albedo, and Eq. 1 fitted without highlights "
            "(Lambert) and with them (Blinn-Phong), each with light and reflectance of its own. "
            "Below: specularity, and what either leaves unexplained, blue where it is too dark and "
            f"red where it is too bright; grey is not compared. Lambert leaves "
            f"{100 * lambertian.unexplained:.1f} % of the median brightness on the mean, "
            f"Blinn-Phong {100 * phong.unexplained:.1f} %."
        ),
        differs=(
            "The specular exponent is 12 for everybody. Albedo is piecewise smooth by the same "
            "robust term. The paper shows no specularity and no residuals."
        ),
        picture=stacked(
            [
                row(
                    [
                        ("brightness of the picture", grey),
                        ("albedo", albedo),
                        ("Lambert", flat),
                        ("Blinn-Phong", glossy),
                    ]
                ),
                row(
                    [
                        ("specularity", gloss),
                        ("Lambert: too dark, too bright", off_flat),
                        ("Blinn-Phong: too dark, too bright", off_glossy),
                    ]
                ),
            ]
        ),
    )


def refit(request: FitRequest, result: FitResult, specular_exponent: float | None) -> Refit | None:
    """Light and reflectance on the fitted body, from its light on; None if too little is seen.

    ``specular_exponent`` is α; None for that of every fit.
    """
    (view,), light = result.views, result.person.light
    assert light is not None
    prepared = prepared_model(request.person.gender)
    (asked,) = request.views
    observation = observe(
        asked, max_pixels=request.choices.max_pixels, detector=PACKAGED.detector_for(asked)
    )
    mask = view.pictures.segmentation
    objective = silhouette_and_edges(
        observation,
        prepared,
        result.person.body,
        Segmentation(mask=mask, warnings=()),
        boundary_eta_m=NEAR_BOUNDARY_ETA_M,
    )
    intensity = intensity_map(observation.luminance, observation.display, mask)
    body = objective.evaluate(result.person.body)
    state = first_shading(objective, body, intensity, (light,))
    if state is None:
        return None
    if specular_exponent is not None:
        state = replace(
            state, reflectance=replace(state.reflectance, specular_exponent=specular_exponent)
        )
    for number, smoothness in enumerate(SMOOTHNESS_SCHEDULE):
        state = next_shading(
            objective, body, state, smoothness=smoothness, light_is_new=number == 0
        )
    return _compared(shaded_fit(objective, body, state), intensity)


def _compared(shaded: ShadedFit, intensity: IntensityMap) -> Refit:
    rendering = shaded.body.rendering
    predicted = shade(
        rendering.vertices,
        rendering.vertex_normals,
        light=shaded.light,
        body_centre=shaded.body.parameters.translation,
        reflectance=shaded.reflectance,
    )
    seen = seen_vertices(rendering, intensity)
    residual = np.zeros(len(predicted))
    observed = intensity.at(rendering.projected[seen])
    residual[seen] = (predicted[seen] - observed) / max(float(np.median(observed)), 1e-3)
    return Refit(
        shaded=shaded,
        predicted=predicted,
        residual=residual,
        seen=seen,
        areas=vertex_areas(rendering.vertices, rendering.triangles),
    )


def _residual_colours(fitted: Refit) -> Float[np.ndarray, "m 3"]:
    """White where explained, toward red where too bright and blue where too dark."""
    share = np.clip(fitted.residual / _MOST_RESIDUAL, -1.0, 1.0)
    colours = np.ones((len(share), 3))
    colours[:, 1:] -= np.maximum(share, 0.0)[:, None]
    colours[:, :2] -= np.maximum(-share, 0.0)[:, None]
    colours[~fitted.seen] = _UNSEEN
    return np.clip(colours, 0.0, 1.0)


def _luminance_levels(request: FitRequest, result: FitResult) -> np.ndarray:
    """The picture's brightness where the person is, before white paper."""
    (view,) = result.views
    levels = to_levels(view.pictures.image.mean(axis=2))
    return np.where(view.pictures.segmentation, levels, 255).astype(np.uint8)
