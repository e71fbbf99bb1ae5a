"""The terms of the energy, each once: of a picture, and of the shape whatever the pictures.

The objectives sum their energies, and the normal equations walk through their rows. Formulas are in
the terms' own modules.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from fitter.arrays import Shape
from fitter.body.pose_prior import prior_energy, prior_terms
from fitter.energies.attributes import (
    KnownAttributes,
    ShapeEquations,
    attribute_energy,
    attribute_equations,
)
from fitter.energies.clicks import click_energy, click_rows
from fitter.energies.correspondence_lines import line_energy, line_rows
from fitter.energies.edges import edge_energy, edge_rows
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.limb_slants import SlantEvidence, slant_energy, slant_rows
from fitter.energies.penetration import penetration_energy, penetration_rows
from fitter.energies.picture import PictureEvidence, SeenBody
from fitter.energies.priors import ShapePrior
from fitter.energies.rows import Rows
from fitter.energies.scales import EnergyScales
from fitter.energies.shading import ShadingEvidence, shading_energy, shading_rows
from fitter.energies.silhouette import silhouette_energy, silhouette_rows
from fitter.energies.stance import stance_rows
from fitter.evidence.correspondence_lines import CorrespondenceLines


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
