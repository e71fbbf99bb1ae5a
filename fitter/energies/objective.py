"""The energies E1 and E2 of one picture, as functions of the body (section 6).

E1 = E_Si + E_Eg + E_Pn and E2 = E1 + E_Sh. Clicks and a prior on the pose are added to both: the
paper's simplex starts near the solution and stays there, while a fit from arbitrary clicks needs to
know what is plausible. What is known of the shape is the person's, whatever the pictures
(:mod:`fitter.energies.joint_objective`).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace

import numpy as np

from fitter.arrays import Mask
from fitter.body.model import regress
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.penetration import sphere_positions
from fitter.energies.picture import PictureEvidence, SeenBody
from fitter.energies.scales import EnergyScales
from fitter.energies.shading import ShadingEvidence
from fitter.energies.silhouette import silhouette_overlap
from fitter.energies.stance import most_probable_tilt
from fitter.energies.terms import Term, terms_of
from fitter.errors import NumericalError
from fitter.evidence.correspondence_lines import CorrespondenceLines
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
