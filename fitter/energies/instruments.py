"""Everything about one body model that every fit with it shares; built once a gender."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.body.pose_prior import PosePrior, pose_prior
from fitter.body.scape import ScapeEvaluator
from fitter.body.tangent import Attachments, TangentModel, attached_rows, tangent_model
from fitter.energies.penetration import PenetrationProxy, penetration_proxy
from fitter.numerics.mesh_topology import MeshTopology, mesh_topology
from fitter.numerics.normals import VertexRings, summed_cross_products, vertex_rings
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyInstruments:
    """A body model, ready to fit.

    Attributes
    ----------
    vertex_areas
        (m,) a third of the area round each vertex of the mean body, as a share of the whole:
        energies over vertices are weighted by it, because head, hands and feet hold most of the
        triangles.
    landmark_attachments, sphere_attachments
        How the model's landmarks and the spheres of the penetration proxy hang on the body.
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
    vertex_areas: Float[np.ndarray, " m"]


def body_instruments(model: BodyModel) -> BodyInstruments:
    """Prepare a model for fitting."""
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
    areas = np.linalg.norm(summed_cross_products(model.mean_vertices, model.triangles), axis=1)
    return BodyInstruments(
        model=model,
        evaluator=evaluator,
        tangent=tangent,
        topology=mesh_topology(model.triangles, vertex_count=m),
        rings=vertex_rings(model.triangles, m),
        pose_prior=pose_prior(model.part_names, model.part_parent, tangent.joints_mean),
        penetration=penetration,
        landmark_attachments=attached_rows(tangent, model.landmarks),
        sphere_attachments=attached_rows(tangent, penetration.centres),
        vertex_areas=areas / areas.sum(),
    )
