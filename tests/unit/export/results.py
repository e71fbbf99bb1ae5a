"""Whole results of a small body, without fitting."""

from dataclasses import replace

import numpy as np

from fitter.body.model import BodyModel
from fitter.parameters import BodyParameters, Light, Reflectance
from fitter.person.fitted_person import FittedPerson
from fitter.render.camera import Camera
from fitter.result import FitResult, FitStage, FittedView, PictureFit, Pictures, StageBody
from fitter.segmentation.trimap import TrimapLabel
from fitter.vocabulary.choices import Cues, Gender, LightKind, OptimizerKind
from fitter.vocabulary.outcomes import FocalLengthSource, Outcome

CAMERA = Camera(focal_length_px=700.0, centre_x=250.0, centre_y=200.0, width=480, height=400)
POINT_LIGHT = Light(kind=LightKind.POINT, azimuth=0.5, elevation=0.3, distance=2.5)
SUN = Light(kind=LightKind.DIRECTIONAL, azimuth=-0.8, elevation=0.6, distance=np.inf)


def reflectance_of(model: BodyModel, *, brightest: float = 0.8) -> Reflectance:
    m = len(model.mean_vertices)
    return Reflectance(
        albedo=np.linspace(0.2, brightest, m),
        specularity=np.linspace(0.0, 0.3, m),
        ambient=0.07,
        specular_exponent=14.0,
    )


def result_of(
    model: BodyModel,
    *,
    light: Light | None = POINT_LIGHT,
    reflectance: Reflectance | None = None,
    albedo_rgb: np.ndarray | None = None,
    count: int = 1,
) -> FitResult:
    """A body before the camera, in so many pictures; SE when ``light`` is None.

    Before shading it stood 5 cm farther off and was 2 % narrower.
    """
    translation = np.array([0.1, 0.5, 3.0])
    posed = model.mean_vertices * [1.0, -1.0, -1.0] + translation
    body = BodyParameters(pose=np.zeros((3, 3)), translation=translation, shape=np.zeros(2))
    farther = StageBody(body=body, posed_vertices=posed + [0.0, 0.0, 0.05], silhouette_overlap=0.88)
    outlined = FitStage(
        name="SE",
        bodies=(farther,) * count,
        canonical_vertices=model.mean_vertices * [0.98, 1.0, 1.0],
        energies={},
        measurements=(),
    )
    shaded = replace(outlined, name="SES")
    working = CAMERA.scaled(0.5, width=240, height=200)
    height, width = working.height, working.width
    segmentation = np.zeros((height, width), dtype=bool)
    segmentation[40:160, 90:150] = True
    trimap = np.where(segmentation, TrimapLabel.FOREGROUND, TrimapLabel.BACKGROUND)
    trimap[30:50, 80:160] = TrimapLabel.LIKELY_BACKGROUND
    if reflectance is None and light is not None:
        reflectance = reflectance_of(model)
    person = FittedPerson(
        gender=Gender.FEMALE,
        model_checksum=model.checksum,
        body=body,
        camera=CAMERA,
        light=light,
        reflectance=None if light is None else reflectance,
        albedo_rgb=None if light is None else albedo_rgb,
        shape_covariance=np.diag([0.0, 0.04]),
    )
    view = FittedView(
        kind=None,
        found=PictureFit(
            person=person,
            height_m=1.3,
            cues=Cues.SE if light is None else Cues.SES,
            outcome=Outcome.CONVERGED,
            posed_vertices=posed,
            silhouette_overlap=0.9,
        ),
        camera=working,
        focal_length_source=FocalLengthSource.CALLER,
        limb_facing=(),
        assumptions=(),
        warnings=(),
        pictures=Pictures(
            image=np.zeros((height, width, 3)),
            trimap=trimap.astype(np.uint8),
            segmentation=segmentation,
        ),
    )
    return FitResult(
        views=(view,) * count,
        shape=body.shape,
        shape_covariance=np.diag([0.0, 0.04]),
        canonical_vertices=model.mean_vertices,
        triangles=model.triangles,
        measurements=(),
        given=("stature",),
        optimizer=OptimizerKind.GAUSS_NEWTON,
        energies={},
        evaluations=1,
        stages=(outlined,) if light is None else (outlined, shaded),
        alone=None,
        assumptions=(),
        warnings=(),
        stage_seconds={},
    )
