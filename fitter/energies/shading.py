"""Shading energy E_Sh: predicted against observed intensity at the visible vertices (Eq. 2).

The observed intensity r_i is the picture's linear luminance, where it can be trusted. This is the
first term of Eq. 2. The smoothness of albedo and specularity depends on the body only through
distances between neighbours, which are held while the body moves; it lives in
:mod:`fitter.optimizer.reflectance_solve`. Vertices are weighted by area. The weighted mean over the
visible vertices is taken, not the sum: a body must not gain by hiding.

How well Eq. 1 holds differs between pictures: cloth, hair, a second lamp and a painter's hand are
not in it. So the variance of what it leaves unexplained is an unknown of the picture, as that of
Gaussian residuals would be, and is taken at its most probable value. With L the mean of
ρ(r̂ - r) and n independent patches, the energy is

    E = n/2 log(1 + L/L₀),

whose slope n/2 / (L₀ + L) is what Eq. 2's mean weighs: little where much stays unexplained. L₀ is
what is left on the true body.
"""

from dataclasses import dataclass, replace

import cv2
import numpy as np
from jaxtyping import Bool, Float, Integer

from fitter.arrays import GreyImage, Image, Mask, PerVertex, Points2D, Vector3
from fitter.energies._picture_kernels import facing_camera
from fitter.energies.rows import ShadingRows, geman_mcclure, geman_mcclure_weights
from fitter.energies.scales import EnergyScales
from fitter.observation.maps import sample
from fitter.parameters import Light, Reflectance
from fitter.render.rasterizer import Rendering
from fitter.render.reflectance import shade, shade_with_derivatives

# Vertices of trunk and limbs project a few pixels apart; finer detail is texture.
_SMOOTHING_PX = 1.5
# Pixels this near the outline mix person and background.
_RIM_PX = 3
_CLIPPED_DISPLAY_VALUE = 0.985


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class IntensityMap:
    """Linear luminance of the person.

    Attributes
    ----------
    luminance
        (h, w) linear, smoothed within the person.
    trusted
        (h, w) on the person, off its rim, not clipped.
    """

    luminance: GreyImage
    trusted: Mask

    def at(self, points: Points2D) -> Float[np.ndarray, " k"]:
        """Luminance at continuous pixels, linearly interpolated."""
        return sample(self.luminance, points)[0]

    def with_gradient_at(self, points: Points2D) -> tuple[Float[np.ndarray, " k"], Points2D]:
        """Luminance and its derivative per pixel."""
        return sample(self.luminance, points)

    def trusted_at(self, points: Points2D) -> Bool[np.ndarray, " k"]:
        """Whether the pixel that holds each point can be trusted; points lie in the picture."""
        height, width = self.trusted.shape
        columns = np.clip(points[:, 0].astype(int), 0, width - 1)
        rows = np.clip(points[:, 1].astype(int), 0, height - 1)
        return self.trusted[rows, columns]

    def without(self, region: Mask) -> "IntensityMap":
        """The same with nothing to trust in a region (h, w)."""
        return replace(self, trusted=self.trusted & ~region)


def intensity_map(luminance: GreyImage, display: Image, mask: Mask) -> IntensityMap:
    """Prepare the person's luminance.

    Smoothing is normalised by the mask: the background never bleeds into the person.
    """
    inside = mask.astype(np.float32)
    spread = cv2.GaussianBlur(inside, (0, 0), _SMOOTHING_PX)
    smooth = cv2.GaussianBlur(luminance.astype(np.float32) * inside, (0, 0), _SMOOTHING_PX)
    smooth = np.where(mask, smooth / np.maximum(spread, 1e-6), luminance).astype(np.float32)
    region = np.ascontiguousarray(mask).view(np.uint8)
    depth = cv2.distanceTransform(region, cv2.DIST_L2, cv2.DIST_MASK_5)
    clipped = (display >= _CLIPPED_DISPLAY_VALUE).any(axis=2)
    return IntensityMap(luminance=smooth, trusted=(depth > _RIM_PX) & ~clipped)


# Below this cosine, toward the rim, a vertex's pixel mixes body and background.
_LEAST_FACING = 0.25


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShadingEvidence:
    """Intensities, with the light and reflectance that should explain them.

    Attributes
    ----------
    intensity
        The picture's linear luminance and where it can be trusted.
    light, body_centre
        ``body_centre`` is the origin of the light's coordinates, camera frame: the body's root
        joint. The light keeps its coordinates while the body moves: a lamp of unknown place must
        not tell how far away the body is, by lighting it more brightly nearer by.
    reflectance
        Per-vertex albedo and specularity, ambient and exponent.
    vertex_areas
        (m,) shares of the body's area; vertices with zero area are ignored.
    shadowed
        (m,) vertices in a cast shadow when the light was last found, and those around them: Eq. 1
        has no cast shadows, and a body fitted to one bulges to turn away from the light.
    eta
        η₁ in units of luminance.
    """

    intensity: IntensityMap
    light: Light
    body_centre: Vector3
    reflectance: Reflectance
    vertex_areas: PerVertex
    shadowed: Bool[np.ndarray, " m"]
    eta: float

    def about(self, body_centre: Vector3) -> "ShadingEvidence":
        """The same with the light about another place of the body's root joint."""
        return replace(self, body_centre=body_centre)

    def reflectance_of(self, vertices: Integer[np.ndarray, " k"]) -> Reflectance:
        """The reflectance of some vertices, in their order."""
        return replace(
            self.reflectance,
            albedo=self.reflectance.albedo[vertices],
            specularity=self.reflectance.specularity[vertices],
        )


def seen_vertices(rendering: Rendering, intensity: IntensityMap) -> Bool[np.ndarray, " m"]:
    """Visible vertices, not near the rim, whose pixel is neither clipped nor off the person."""
    return _seen_among(rendering.vertex_visible, rendering, intensity)


def _seen_among(
    visible: Bool[np.ndarray, " m"], rendering: Rendering, intensity: IntensityMap
) -> Bool[np.ndarray, " m"]:
    seen = np.empty_like(visible)
    facing_camera(
        rendering.vertices,
        rendering.vertex_normals,
        visible,
        _LEAST_FACING,
        seen,
    )
    seen[seen] = intensity.trusted_at(rendering.projected[seen])
    return seen


def usable_vertices(rendering: Rendering, evidence: ShadingEvidence) -> Bool[np.ndarray, " m"]:
    """Seen vertices that take part and follow Eq. 1, being in no cast shadow."""
    taking_part = (evidence.vertex_areas > 0.0) & ~evidence.shadowed
    return _seen_among(rendering.vertex_visible & taking_part, rendering, evidence.intensity)


def shading_energy(rendering: Rendering, evidence: ShadingEvidence, scales: EnergyScales) -> float:
    """Data term of E_Sh in nats."""
    chosen = np.flatnonzero(usable_vertices(rendering, evidence))
    weights = evidence.vertex_areas[chosen]
    if not weights.sum() > 0.0:
        return _nats(1.0, scales)
    predicted = shade(
        rendering.vertices[chosen],
        rendering.vertex_normals[chosen],
        light=evidence.light,
        body_centre=evidence.body_centre,
        reflectance=evidence.reflectance_of(chosen),
    )
    observed = evidence.intensity.at(rendering.projected[chosen])
    return _nats(_unexplained(predicted - observed, weights, evidence.eta), scales)


def shading_rows(
    rendering: Rendering, evidence: ShadingEvidence, scales: EnergyScales
) -> ShadingRows:
    """One row per usable vertex."""
    chosen = np.flatnonzero(usable_vertices(rendering, evidence))
    positions = rendering.vertices[chosen]
    derivatives = shade_with_derivatives(
        positions,
        rendering.vertex_normals[chosen],
        light=evidence.light,
        body_centre=evidence.body_centre,
        reflectance=evidence.reflectance_of(chosen),
    )
    observed, slopes = evidence.intensity.with_gradient_at(rendering.projected[chosen])
    residuals = derivatives.shading - observed
    areas = evidence.vertex_areas[chosen]
    left = scales.shading_floor + _unexplained(residuals, areas, evidence.eta)
    share = scales.shading_weight / left * areas / max(float(areas.sum()), 1e-12)
    return ShadingRows(
        residuals=residuals,
        weights=share * geman_mcclure_weights(residuals, evidence.eta),
        vertices=chosen,
        position_derivatives=derivatives.by_position
        - rendering.camera.pull_back(positions, slopes),
        normal_derivatives=derivatives.by_normal,
        centre_derivatives=derivatives.by_body_centre,
    )


def _unexplained(
    residuals: Float[np.ndarray, " k"], areas: Float[np.ndarray, " k"], eta: float
) -> float:
    """L: the area-weighted mean of ρ; 1 where nothing is seen."""
    total = float(areas.sum())
    return float(areas @ geman_mcclure(residuals, eta)) / total if total > 0.0 else 1.0


def _nats(unexplained: float, scales: EnergyScales) -> float:
    return scales.shading_weight * float(np.log1p(unexplained / scales.shading_floor))


def thinned_shading(rows: ShadingRows, limit: int) -> ShadingRows:
    """Systematic sampling of rows in proportion to weight, reweighted to represent all."""
    total = float(rows.weights.sum())
    if len(rows.residuals) <= limit or not total > 0.0:
        return rows
    marks = (np.arange(limit) + 0.5) / limit
    chosen = np.searchsorted(np.cumsum(rows.weights) / total, marks)
    return ShadingRows(
        residuals=rows.residuals[chosen],
        weights=np.full(limit, total / limit),
        vertices=rows.vertices[chosen],
        position_derivatives=rows.position_derivatives[chosen],
        normal_derivatives=rows.normal_derivatives[chosen],
        centre_derivatives=rows.centre_derivatives[chosen],
    )
