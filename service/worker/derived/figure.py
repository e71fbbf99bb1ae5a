"""Picture, overlay, recovered body and a new pose as one picture, as in the paper's Fig. 10."""

from collections.abc import Callable

import numpy as np

from api_schemas.derivation_kinds.figure import FigureOptions, FigureResult
from fitter.applications.figure import figure_picture
from fitter.applications.rig import rig_of
from fitter.export.display import png
from fitter.observation.decoding import decode_picture
from fitter.parameters import BodyParameters
from service.jobs.inputs import IMAGE, OVERLAY, PERSON
from service.worker.derived.person import person_and_operators
from service.worker.derived.pose import pose_named, reposed_glb
from service.worker.pipeline_port import DerivationInput, DerivationOutput


def derive(
    job: DerivationInput[FigureOptions], observe: Callable[[float], None]
) -> DerivationOutput[FigureResult]:
    """Draw the figure; see :class:`service.worker.derivers.Deriver`."""
    options = job.options
    person, operators = person_and_operators(job.inputs[PERSON], job.models)
    model, evaluator = operators.model, operators.evaluator
    picture, overlay = (
        decode_picture(job.inputs[name], field="image", max_pixels=job.max_pixels).pixels
        for name in (IMAGE, OVERLAY)
    )
    shape = person.body.shape
    pose = pose_named(rig_of(model, shape), options.pose)
    reposed = BodyParameters(pose=pose, translation=np.zeros(3), shape=shape)
    standing = evaluator.body_frame_vertices(reposed)
    drawn = figure_picture(
        picture,
        overlay,
        evaluator.body_frame_vertices(person.body),
        standing,
        model.triangles,
        degrees=options.degrees,
        pose_name=options.pose.value.replace("_", " "),
    )
    return DerivationOutput(
        result=FigureResult(pose=options.pose, artifacts=()),
        artifacts={
            "figure.png": png(drawn),
            "body_reposed.glb": reposed_glb(standing, model, person, options.pose),
        },
    )
