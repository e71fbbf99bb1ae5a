"""The energies E1 and E2 of one picture, as functions of the body (section 6).

E1 = E_Si + E_Eg + E_Pn and E2 = E1 + E_Sh. Clicks and a prior on the pose are added to both: the
paper's simplex starts near the solution and stays there, while a fit from arbitrary clicks needs to
know what is plausible. What is known of the shape is the person's, whatever the pictures
(:mod:`fitter.energies.joint_objective`).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Points3D, Vertices
from fitter.body.pose_prior import prior_residuals
from fitter.body.skeleton import regress
from fitter.energies.clicks import ClickEvidence, click_energy
from fitter.energies.correspondence_lines import line_energy
from fitter.energies.edges import edge_energy
from fitter.energies.fitting_operators import FittingOperators
from fitter.energies.limb_slants import SlantEvidence, slant_energy
from fitter.energies.penetration import penetration_energy, sphere_positions
from fitter.energies.scales import EnergyScales
from fitter.energies.shading import ShadingEvidence, shading_energy
from fitter.energies.silhouette import silhouette_energy, silhouette_overlap
from fitter.energies.stance import Tilt, most_probable_tilt
from fitter.errors import NumericalError
from fitter.evidence.correspondence_lines import CorrespondenceLines
from fitter.evidence.edge_cost import EdgeCostMap
from fitter.evidence.loose_outline import LooseClothes
from fitter.evidence.silhouette_evidence import SilhouetteEvidence
from fitter.parameters import BodyParameters
from fitter.render.camera import Camera
from fitter.render.contours import ModelEdges, model_edges
from fitter.render.rasterizer import Rendering, render
from fitter.vocabulary.choices import Posture

EnergyObserver = Callable[[Mapping[str, float]], None]
"""Receives energies by term as a search goes on."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PictureEvidence:
    """What the picture says.

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
    """What one picture says, as a function of the body: operators, evidence and scales are fixed.

    ``posture`` is what is known of how the person stands.
    """

    operators: FittingOperators
    evidence: PictureEvidence
    scales: EnergyScales
    posture: Posture = Posture.ANY

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
        operators, evidence, scales = self.operators, self.evidence, self.scales
        parameters, rendering = seen.parameters, seen.rendering
        energies = {
            "silhouette": silhouette_energy(rendering, evidence.silhouette, scales)
            if evidence.lines is None
            else line_energy(rendering, evidence.lines, scales),
            "edges": edge_energy(seen.edges, evidence.edges, scales, evidence.bare),
            "penetration": penetration_energy(
                seen.spheres, seen.radii, operators.penetration, scales
            ),
            "clicks": click_energy(seen.landmarks, evidence.clicks, evidence.camera, scales),
            "pose_prior": 0.5
            * float((prior_residuals(operators.pose_prior, parameters.pose) ** 2).sum()),
            "stance": seen.tilt.energy,
        }
        if evidence.slants is not None:
            energies["limb_slants"] = slant_energy(seen.landmarks, evidence.slants)
        if evidence.shading is not None:
            shading = evidence.shading.about(parameters.translation)
            energies["shading"] = shading_energy(rendering, shading, scales)
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

    def with_lines(self, lines: CorrespondenceLines) -> "Objective":
        """The same objective with another outline to fit."""
        return replace(self, evidence=replace(self.evidence, lines=lines))

    def with_shading(self, shading: ShadingEvidence) -> "Objective":
        """The same objective with another shading term."""
        return replace(self, evidence=replace(self.evidence, shading=shading))
