"""The energies E1 and E2 as functions of the body: of one picture, and of one person in several.

E1 = E_Si + E_Eg + E_Pn and E2 = E1 + E_Sh (section 6). Clicks and a prior on the pose are added to
both: the paper's simplex starts near the solution and stays there, while a fit from arbitrary
clicks needs to know what is plausible.

With one shape β, a pose and place θ_k in picture k, and E_k what that picture says,

    E(β, θ_1 ... θ_K) = w Σ_k E_k(β, θ_k) + prior(β) + known(β).

What is known of the shape counts once, however many pictures there are. Held attributes have no
term: a search stays among the bodies that have them. The weight w is one for one picture, and less
where several share part of their errors.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from fitter.arrays import Mask, Shape
from fitter.body.model import regress
from fitter.energies.correspondence_lines import CorrespondenceLines
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.penetration import sphere_positions
from fitter.energies.scales import EnergyScales
from fitter.energies.shading import ShadingEvidence
from fitter.energies.shape_terms import KnownAttributes, ShapeEquations, ShapePrior
from fitter.energies.silhouette import silhouette_overlap
from fitter.energies.stance import most_probable_tilt
from fitter.energies.terms import (
    PictureEvidence,
    SeenBody,
    ShapeTerm,
    Term,
    shape_terms_of,
    terms_of,
)
from fitter.errors import NumericalError
from fitter.parameters import BodyParameters
from fitter.render.contours import model_edges
from fitter.render.rasterizer import render
from fitter.vocabulary.choices import Posture

EnergyObserver = Callable[[Mapping[str, float]], None]
"""Receives energies by term as a search goes on."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Candidate(SeenBody):
    """A body with its energies under one objective."""

    energies: Mapping[str, float]

    @property
    def total(self) -> float:
        """The sum of all terms, nats."""
        return sum(self.energies.values())


Body = BodyParameters | SeenBody
"""A body, or one that was seen already and need not be rendered again."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Objective:
    """Energy of one picture as a function of the body: operators, evidence and scales are fixed.

    Attributes
    ----------
    posture
        What is known of how the person stands.
    counted
        Names of the terms whose sum it is; None for all.
    """

    operators: FittingOperators
    evidence: PictureEvidence
    scales: EnergyScales
    posture: Posture = Posture.ANY
    counted: frozenset[str] | None = None

    @property
    def terms(self) -> tuple[Term, ...]:
        """The energies whose sum it is."""
        terms = terms_of(self.operators, self.evidence, self.scales)
        if self.counted is None:
            return terms
        return tuple(term for term in terms if term.name in self.counted)

    def see(self, body: Body) -> SeenBody:
        """A body posed and rendered; one that was seen before is returned as it is.

        Evidence and scales have no part in it: what was seen under one objective can be judged
        under others of the same picture.
        """
        if isinstance(body, SeenBody):
            return body
        operators, evidence = self.operators, self.evidence
        vertices = operators.evaluator.vertices(body)
        rendering = render(vertices, operators.model.triangles, evidence.camera)
        joints = regress(operators.model.joint_regressor, vertices)
        spheres, radii = sphere_positions(operators.penetration, vertices)
        return SeenBody(
            parameters=body,
            vertices=vertices,
            rendering=rendering,
            edges=model_edges(rendering, operators.topology),
            landmarks=regress(evidence.clicks.landmarks, vertices),
            joints=joints,
            tilt=most_probable_tilt(joints, operators.stance_vectors, self.posture),
            spheres=spheres,
            radii=radii,
        )

    def evaluate(self, body: Body) -> Candidate:
        """The true energy of a body.

        Raises
        ------
        NumericalError
            If a term is not finite.
        """
        seen = self.see(body)
        energies = {term.name: term.energy(seen) for term in self.terms}
        for name, value in energies.items():
            if not np.isfinite(value):
                message = f"The {name} energy is {value}."
                raise NumericalError(message)
        return Candidate(
            **{each.name: getattr(seen, each.name) for each in fields(SeenBody)},
            energies=energies,
        )

    def overlap(self, candidate: Candidate) -> float:
        """Intersection over union of the body's silhouette and the observed one."""
        return silhouette_overlap(candidate.rendering, self.evidence.silhouette, self.scales)

    def doubting(self, region: Mask) -> "Objective":
        """The same objective with no outline and no edge in a region (h, w)."""
        if not region.any():
            return self
        evidence = self.evidence
        return replace(
            self,
            evidence=replace(
                evidence,
                silhouette=evidence.silhouette.doubting(region),
                edges=evidence.edges.without(region),
            ),
        )

    def with_lines(self, lines: CorrespondenceLines) -> "Objective":
        """The same objective with another outline to fit."""
        return replace(self, evidence=replace(self.evidence, lines=lines))

    def with_shading(self, shading: ShadingEvidence) -> "Objective":
        """The same objective with another shading term."""
        return replace(self, evidence=replace(self.evidence, shading=shading))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointCandidate:
    """One shape, posed in each picture, with its energies.

    ``energies`` are those of the whole: each picture's terms, weighted and summed by name, and
    those of the shape.
    """

    views: tuple[Candidate, ...]
    energies: Mapping[str, float]

    @property
    def total(self) -> float:
        """The sum of all terms, nats."""
        return sum(self.energies.values())

    @property
    def shape(self) -> Shape:
        """(n,) that all bodies have."""
        return self.views[0].parameters.shape

    @property
    def bodies(self) -> tuple[BodyParameters, ...]:
        """The body in each picture."""
        return tuple(view.parameters for view in self.views)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointObjective:
    """See the module.

    Attributes
    ----------
    views
        What each picture says.
    weight
        w.
    shape_prior, attributes
        What is known of the shape; held attributes have no term.
    """

    views: tuple[Objective, ...]
    weight: float
    shape_prior: ShapePrior
    attributes: KnownAttributes

    @property
    def shape_terms(self) -> tuple[ShapeTerm, ...]:
        """Energies of what is known of the shape."""
        return shape_terms_of(self.shape_prior, self.attributes)

    def shape_equations(self, shape: Shape) -> ShapeEquations:
        """Matrix and gradient of what is known of the shape."""
        n = len(shape)
        matrix, gradient = np.zeros((n, n)), np.zeros(n)
        for term in self.shape_terms:
            own, slope = term.equations(shape)
            matrix, gradient = matrix + own, gradient + slope
        return matrix, gradient

    def evaluate(self, bodies: Sequence[Body]) -> JointCandidate:
        """The true energy of bodies of one shape.

        Raises
        ------
        NumericalError
            If a term is not finite.
        """
        found = [view.evaluate(body) for view, body in zip(self.views, bodies, strict=True)]
        shape = found[0].parameters.shape
        energies: dict[str, float] = {}
        for each in found:
            for name, energy in each.energies.items():
                energies[name] = energies.get(name, 0.0) + self.weight * energy
        energies |= {term.name: term.energy(shape) for term in self.shape_terms}
        return JointCandidate(views=tuple(found), energies=energies)

    def with_views(self, views: Sequence[Objective]) -> "JointObjective":
        """The same with other evidence."""
        return replace(self, views=tuple(views))
