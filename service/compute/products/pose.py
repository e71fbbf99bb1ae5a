"""The fitted body in another pose."""

import numpy as np

from api_schemas.products.base import BodyColours
from api_schemas.products.bodies import NamedPose, PoseOptions, PoseResult
from fitter.applications.poses import Rig, named_pose, rig_of, spelled_pose
from fitter.arrays import Pose, Vertices
from fitter.body.model import BodyModel
from fitter.export.display import png
from fitter.export.glb import Frame
from fitter.export.gltf import plain_glb
from fitter.export.gltf_mesh import BodyTexture
from fitter.export.views import BodyView, preview
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from service.compute.fit_results import body_result
from service.compute.products.finished_fit import FinishedFit, Made, Report
from service.compute.products.pictured_body import texture_files, texture_for


def pose_named(rig: Rig, name: NamedPose) -> Pose:
    """A pose named in a request, for a person's skeleton."""
    if name is NamedPose.REST:
        return np.zeros((len(rig.part_names), 3))
    return named_pose(rig, name.value)


def reposed_glb(
    vertices: Vertices,
    model: BodyModel,
    person: FittedPerson,
    name: NamedPose,
    texture: BodyTexture | None = None,
) -> bytes:
    """A person's body on the ground in a pose, which is named in the file."""
    return plain_glb(
        vertices,
        model,
        name="body_reposed",
        frame=Frame.ON_THE_GROUND,
        extras={"pose": name.value},
        reflectance=person.reflectance,
        albedo_rgb=person.albedo_rgb,
        texture=texture,
    )


def make(fit: FinishedFit, options: PoseOptions, report: Report) -> Made[PoseResult]:
    """Pose the body."""
    person, model = fit.person, fit.operators.model
    rig = rig_of(model, person.body.shape)
    pose = spelled_pose(rig, options.rotations, beginning=pose_named(rig, options.pose))
    body = BodyParameters(pose=pose, translation=np.zeros(3), shape=person.body.shape)
    vertices = fit.operators.evaluator.body_frame_vertices(body)
    report(0.2)
    texture = texture_for(options.colours, fit)
    report(0.8)
    views = [
        BodyView(label=label, vertices=vertices, degrees=degrees)
        for label, degrees in (("front", 0.0), ("side", 90.0))
    ]
    return Made(
        result=PoseResult(
            pose=body_result(body, model.part_names).pose,
            colours=BodyColours.PLAIN if texture is None else options.colours,
        ),
        files={
            "body_reposed.glb": reposed_glb(vertices, model, person, options.pose, texture),
            "pose.png": png(preview(views, model.triangles, texture)),
        }
        | texture_files(texture),
    )
