"""A caricature of the fitted body."""

import dataclasses

from api_schemas.products.base import BodyColours
from api_schemas.products.bodies import (
    CaricatureOptions,
    CaricatureResult,
    Exaggerated,
)
from fitter.applications.caricature import caricature_of_looks, caricature_of_most_unusual
from fitter.export.display import png
from fitter.export.glb import Frame
from fitter.export.gltf import plain_glb
from fitter.export.views import BodyView, preview
from fitter.person.upright import upright_turn
from service.compute.products.finished_fit import FinishedFit, Made, Report
from service.compute.products.pictured_body import texture_for


def make(fit: FinishedFit, options: CaricatureOptions, report: Report) -> Made[CaricatureResult]:
    """Exaggerate."""
    person = fit.person
    model, evaluator = fit.operators.model, fit.operators.evaluator
    of_looks = options.exaggerated is Exaggerated.LOOKS
    exaggerate = caricature_of_looks if of_looks else caricature_of_most_unusual
    found = exaggerate(evaluator, person.body.shape, options.factor)
    report(0.7)
    turn = upright_turn(person.tilt)
    fitted, exaggerated = (
        evaluator.body_frame_vertices(dataclasses.replace(person.body, shape=shape)) @ turn.T
        for shape in (person.body.shape, found.shape)
    )
    result = CaricatureResult(
        factor=found.factor,
        coefficient=found.coefficient,
        before=found.before,
        after=found.after,
        height_m=found.height_m,
        shape=tuple(found.shape.tolist()),
    )
    picture = preview(
        [
            BodyView(label="fitted", vertices=fitted),
            BodyView(label=f"times {found.factor:g}", vertices=exaggerated),
            BodyView(label="fitted, side", vertices=fitted, degrees=90.0),
            BodyView(label=f"times {found.factor:g}, side", vertices=exaggerated, degrees=90.0),
        ],
        model.triangles,
        texture_for(BodyColours.PICTURE, fit),
    )
    return Made(
        result=result,
        files={
            "body_caricature.glb": plain_glb(
                exaggerated,
                model,
                name="body_caricature",
                frame=Frame.CAMERA_TURNED if person.tilt is None else Frame.ON_THE_GROUND,
                extras={
                    "factor": found.factor,
                    "exaggerated": options.exaggerated.value,
                    "coefficient": found.coefficient,
                    "height_m": found.height_m,
                },
                reflectance=person.reflectance,
                albedo_rgb=person.albedo_rgb,
            ),
            "caricature.png": png(picture),
        },
    )
