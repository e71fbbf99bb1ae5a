"""Everything about a body model that all fits with it share; built once per gender."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from fitter.body.lighter_model import LighterModel, lighter_model
from fitter.body.model import BodyModel
from fitter.body.pose_prior import PosePrior, pose_prior
from fitter.body.scape import ScapeEvaluator
from fitter.body.tangent import Attachments, TangentModel, attached_rows, tangent_model
from fitter.energies.penetration import PenetrationProxy, penetration_proxy
from fitter.energies.stance import stance_vectors
from fitter.numerics.meshes import (
    MeshTopology,
    VertexRings,
    mesh_topology,
    vertex_areas,
    vertex_rings,
)
from fitter.numerics.surface_sample import SurfaceSample, surface_sample
from fitter.parameters import BodyParameters

SHADED_SPACING_M = 0.012
"""Minimum distance between the vertices at which shading is evaluated. Trunk and limbs keep theirs,
16 to 32 mm apart; a third of all 12,440 remains."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FittingOperators:
    """A body model, ready to fit.

    Attributes
    ----------
    shaded
        The vertices at which shading is evaluated, chosen on the mean body: head, hands and feet
        hold two thirds of all vertices on a sixth of the skin.
    landmark_attachments, sphere_attachments, joint_attachments
        How the model's landmarks, the spheres of the penetration proxy and the joints are attached
        to the body.
    stance_vectors
        What the camera's tilt is found from (:mod:`fitter.energies.stance`).
    whole
        The body that these are the lighter operators of; None where they are its own.
    """

    model: BodyModel
    evaluator: ScapeEvaluator
    tangent: TangentModel
    topology: MeshTopology
    rings: VertexRings
    pose_prior: PosePrior
    penetration: PenetrationProxy
    landmark_attachments: Attachments
    sphere_attachments: Attachments
    joint_attachments: Attachments
    stance_vectors: Float[np.ndarray, "9 p"]
    shaded: SurfaceSample
    whole: "WholeBody | None" = None

    def whole_vertices(self, parameters: BodyParameters) -> Vertices:
        """Posed vertices of the whole body, camera frame, metres."""
        whole = self if self.whole is None else self.whole.operators
        return whole.evaluator.vertices(parameters)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class WholeBody:
    """The body that is drawn and reported where fewer vertices are searched.

    Attributes
    ----------
    operators
        Of the whole body; ``shaded`` is the lighter one's sample.
    lighter
        The lighter model's place on the whole one.
    """

    operators: FittingOperators
    lighter: LighterModel


def searched_operators(model: BodyModel) -> FittingOperators:
    """Prepare a model for searching on fewer vertices; ``whole`` leads back to all of them."""
    lighter = lighter_model(model)
    searched = fitting_operators(lighter.model)
    whole = _operators(model, lighter.whole_sample(searched.shaded))
    return replace(searched, whole=WholeBody(operators=whole, lighter=lighter))


def fitting_operators(model: BodyModel) -> FittingOperators:
    """Prepare a model for fitting."""
    edges = mesh_topology(model.triangles, vertex_count=len(model.mean_vertices)).edges
    areas = vertex_areas(model.mean_vertices, model.triangles)
    return _operators(
        model, surface_sample(model.mean_vertices, edges, areas, spacing=SHADED_SPACING_M)
    )


def _operators(model: BodyModel, shaded: SurfaceSample) -> FittingOperators:
    evaluator = ScapeEvaluator(model)
    tangent = tangent_model(model)
    canonical = evaluator.body_frame_vertices(
        BodyParameters(
            pose=model.canonical_pose,
            translation=np.zeros(3),
            shape=np.zeros(len(model.shape_basis)),
        )
    )
    penetration = penetration_proxy(model, canonical)
    m = len(model.mean_vertices)
    return FittingOperators(
        model=model,
        evaluator=evaluator,
        tangent=tangent,
        topology=mesh_topology(model.triangles, vertex_count=m),
        rings=vertex_rings(model.triangles, m),
        pose_prior=pose_prior(model.part_names, model.part_parent, tangent.joints_mean),
        penetration=penetration,
        landmark_attachments=attached_rows(tangent, model.landmarks),
        sphere_attachments=attached_rows(tangent, penetration.centres),
        joint_attachments=attached_rows(tangent, model.joint_regressor),
        stance_vectors=stance_vectors(model.part_names),
        shaded=shaded,
    )
