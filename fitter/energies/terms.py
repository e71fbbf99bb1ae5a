"""The terms of the energy, each once: of a picture, and of the shape whatever the pictures.

Terms of a picture are computed from its evidence and a body as its camera sees it. The objectives
sum their energies, and the normal equations walk through their rows. Formulas are in the terms' own
modules.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Points3D, Shape, Vertices
from fitter.body.pose_prior import prior_energy, prior_terms
from fitter.energies.correspondence_lines import CorrespondenceLines, line_energy, line_rows
from fitter.energies.edges import EdgeCostMap, edge_energy, edge_rows
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.landmarks import (
    ClickEvidence,
    SlantEvidence,
    click_energy,
    click_rows,
    slant_energy,
    slant_rows,
)
from fitter.energies.penetration import penetration_energy, penetration_rows
from fitter.energies.rows import Rows
from fitter.energies.scales import EnergyScales
from fitter.energies.shading import ShadingEvidence, shading_energy, shading_rows
from fitter.energies.shape_terms import (
    KnownAttributes,
    ShapeEquations,
    ShapePrior,
    attribute_energy,
    attribute_equations,
)
from fitter.energies.silhouette import silhouette_energy, silhouette_rows
from fitter.energies.stance import Tilt, stance_rows
from fitter.evidence.loose_outline import LooseClothes
from fitter.evidence.silhouette_evidence import SilhouetteEvidence
from fitter.parameters import BodyParameters
from fitter.render.camera import Camera
from fitter.render.contours import ModelEdges
from fitter.render.rasterizer import Rendering
from fitter.vocabulary.outcomes import WornRegion


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PictureEvidence:
    """Evidence of one picture.

    Attributes
    ----------
    silhouette
        The region segmentation found.
    slants
        How limbs slant in depth, None where nothing is known about it.
    lines
        Where the person ends on lines across the contour of a nearby body; the silhouette energy
        is then computed from these. None as long as there is no such body: then it is computed
        from the region.
    clothes
        What is known about loose clothes, None where they are tight: the body's edges under them
        are not those of the picture.
    worn
        How regions are covered; empty where the caller says that all clothes are tight.
    shading
        None for E1.
    """

    camera: Camera
    clicks: ClickEvidence
    slants: SlantEvidence | None = None
    silhouette: SilhouetteEvidence
    lines: CorrespondenceLines | None = None
    edges: EdgeCostMap
    clothes: LooseClothes | None = None
    worn: tuple[WornRegion, ...] = ()
    shading: ShadingEvidence | None

    @property
    def bare(self) -> PerVertex | None:
        """(m,) probability that no loose clothes hide a vertex; None where clothes are tight."""
        return None if self.clothes is None else self.clothes.bare


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SeenBody:
    """One body as a camera sees it: everything that energies are computed from.

    ``joints`` (p, 3) lie in the camera frame, metres; ``tilt`` is the camera's, as they tell it.
    """

    parameters: BodyParameters
    vertices: Vertices
    rendering: Rendering
    edges: ModelEdges
    landmarks: Points3D
    joints: Float[np.ndarray, "p 3"]
    tilt: Tilt
    spheres: Float[np.ndarray, "s 3"]
    radii: Float[np.ndarray, " s"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Term:
    """One energy of a picture, with its evidence.

    Attributes
    ----------
    name
        What its energy is reported by.
    energy
        At a body, nats.
    rows
        The energy near a body as residuals with weights, whose gradient is the energy's own.
    """

    name: str
    energy: Callable[[SeenBody], float]
    rows: Callable[[SeenBody], tuple[Rows, ...]]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ShapeTerm:
    """One energy of the shape alone, which counts once however many pictures there are.

    Attributes
    ----------
    name, energy
        As of a :class:`Term`, at a shape.
    equations
        Matrix (n, n) and gradient (n,) at a shape.
    """

    name: str
    energy: Callable[[Shape], float]
    equations: Callable[[Shape], ShapeEquations]


def terms_of(
    operators: FittingOperators, evidence: PictureEvidence, scales: EnergyScales
) -> tuple[Term, ...]:
    """All terms for which the picture has evidence. A new one is a line here."""
    return (
        _region(evidence, scales) if evidence.lines is None else _lines(evidence.lines, scales),
        _edges(evidence, scales),
        _penetration(operators, scales),
        _clicks(evidence, scales),
        _pose_prior(operators),
        _stance(operators),
        *(() if evidence.slants is None else (_limb_slants(evidence.slants),)),
        *(() if evidence.shading is None else (_shading(evidence.shading, scales),)),
    )


def shape_terms_of(prior: ShapePrior, attributes: KnownAttributes) -> tuple[ShapeTerm, ...]:
    """All terms of what is known of the shape. A new one is a line here."""
    population = ShapeTerm(
        name="shape_prior",
        energy=prior.energy,
        equations=lambda shape: (prior.precision, prior.slope(shape)),
    )
    told = ShapeTerm(
        name="attributes",
        energy=partial(attribute_energy, attributes),
        equations=partial(attribute_equations, attributes),
    )
    return (
        *((population,) if prior.precision.any() else ()),
        *((told,) if len(attributes.standard_errors) else ()),
    )


def _region(evidence: PictureEvidence, scales: EnergyScales) -> Term:
    """The outline as the segmented region has it."""
    region = evidence.silhouette
    return Term(
        name="silhouette",
        energy=lambda seen: silhouette_energy(seen.rendering, region, scales),
        rows=lambda seen: silhouette_rows(seen.rendering, seen.edges, region, scales),
    )


def _lines(lines: CorrespondenceLines, scales: EnergyScales) -> Term:
    """The outline as lines across the contour of a nearby body found it."""
    return Term(
        name="silhouette",
        energy=lambda seen: line_energy(seen.rendering, lines, scales),
        rows=lambda seen: line_rows(seen.rendering, lines, scales),
    )


def _edges(evidence: PictureEvidence, scales: EnergyScales) -> Term:
    cost, bare = evidence.edges, evidence.bare
    return Term(
        name="edges",
        energy=lambda seen: edge_energy(seen.edges, cost, scales, bare),
        rows=lambda seen: (edge_rows(seen.rendering, seen.edges, cost, scales, bare),),
    )


def _penetration(operators: FittingOperators, scales: EnergyScales) -> Term:
    proxy = operators.penetration
    return Term(
        name="penetration",
        energy=lambda seen: penetration_energy(seen.spheres, seen.radii, proxy, scales),
        rows=lambda seen: (penetration_rows(seen.spheres, seen.radii, proxy, scales),),
    )


def _clicks(evidence: PictureEvidence, scales: EnergyScales) -> Term:
    clicks, camera = evidence.clicks, evidence.camera
    return Term(
        name="clicks",
        energy=lambda seen: click_energy(seen.landmarks, clicks, camera, scales),
        rows=lambda seen: (click_rows(seen.landmarks, clicks, camera, scales),),
    )


def _pose_prior(operators: FittingOperators) -> Term:
    prior = operators.pose_prior
    return Term(
        name="pose_prior",
        energy=lambda seen: prior_energy(prior, seen.parameters.pose),
        rows=lambda seen: (prior_terms(prior, seen.parameters.pose),),
    )


def _stance(operators: FittingOperators) -> Term:
    vectors = operators.stance_vectors
    return Term(
        name="stance",
        energy=lambda seen: seen.tilt.energy,
        rows=lambda seen: (stance_rows(seen.joints, vectors, seen.tilt),),
    )


def _limb_slants(slants: SlantEvidence) -> Term:
    return Term(
        name="limb_slants",
        energy=lambda seen: slant_energy(seen.landmarks, slants),
        rows=lambda seen: (slant_rows(seen.landmarks, slants),),
    )


def _shading(shading: ShadingEvidence, scales: EnergyScales) -> Term:
    def about(seen: SeenBody) -> ShadingEvidence:
        return shading.about(seen.parameters.translation)

    return Term(
        name="shading",
        energy=lambda seen: shading_energy(seen.rendering, about(seen), scales),
        rows=lambda seen: (shading_rows(seen.rendering, about(seen), scales),),
    )
