"""Evidence of a picture, and a body as its camera sees it: energies are computed from both."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import PerVertex, Points3D, Vertices
from fitter.energies.clicks import ClickEvidence
from fitter.energies.limb_slants import SlantEvidence
from fitter.energies.shading import ShadingEvidence
from fitter.energies.stance import Tilt
from fitter.evidence.correspondence_lines import CorrespondenceLines
from fitter.evidence.edge_cost import EdgeCostMap
from fitter.evidence.loose_outline import LooseClothes
from fitter.evidence.silhouette_evidence import SilhouetteEvidence
from fitter.observation.covering import WornRegion
from fitter.parameters import BodyParameters
from fitter.render.camera import Camera
from fitter.render.contours import ModelEdges
from fitter.render.rasterizer import Rendering


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
