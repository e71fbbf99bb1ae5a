"""Figs. 2 and 3: the first pose from the clicks, and the person cut out around it."""

from collections.abc import Mapping

import cv2
import numpy as np

from fitter.arrays import Points3D, Shape
from fitter.body.model import regress
from fitter.body.pose_prior import pose_prior
from fitter.body.scape import ScapeEvaluator
from fitter.export.display import to_levels
from fitter.fits.pipeline import PACKAGED
from fitter.fits.prepared_model import prepared_model
from fitter.observation.observation import observe
from fitter.parameters import BodyParameters
from fitter.pose_init.click_fit import turn_head
from fitter.pose_init.click_problem import ClickedPoints, click_problem, clicked_points
from fitter.pose_init.initial_pose import initialize_pose, reference_of
from fitter.pose_init.landmark_rig import landmark_rig
from fitter.pose_init.lifting import Lifting, OrthographicLifting, PerspectiveLifting
from fitter.pose_init.limbs import limb_lengths_m
from fitter.pose_init.start_poses import start_poses
from fitter.pose_init.trunk import trunk_points
from fitter.render.camera import Camera
from fitter.render.rasterizer import render
from fitter.reproduction.panels import (
    Figure,
    Levels,
    coloured_body,
    common_camera,
    in_profile,
    row,
    tinted,
)
from fitter.request import FitRequest
from fitter.result import FitResult
from fitter.segmentation.trimap import trimap_picture
from fitter.vocabulary.choices import Facing

_PROFILE_DEGREES = 70.0
_SILHOUETTE, _PERSON = (0.95, 0.75, 0.1), (0.1, 0.8, 0.3)
_CLICK, _HALO = (40, 230, 90), (0, 0, 0)


def figure_2(request: FitRequest, result: FitResult) -> Figure:
    """Clicks, and what each camera model makes of them, from another view.

    ``result`` is of a fit of the same picture by the paper's method.
    """
    (view,), (found,) = request.views, result.views
    prepared = prepared_model(request.person.gender)
    evaluator, camera = prepared.operators.evaluator, found.camera
    observation = observe(
        view, max_pixels=request.choices.max_pixels, detector=PACKAGED.detector_for(view)
    )
    clicks = clicked_points(observation.clicks)
    shape = result.stages[0].bodies[0].body.shape
    refined = initialize_pose(
        evaluator, camera=camera, clicks=clicks, shape=shape, limb_facing=view.limb_facing
    )
    bodies = [
        *_lifted_both_ways(evaluator, camera, clicks, shape, view.limb_facing),
        refined.parameters,
    ]
    tilt = found.found.person.tilt
    seen = [
        in_profile(evaluator.vertices(each), each.translation, tilt, degrees=_PROFILE_DEGREES)
        for each in bodies
    ]
    fitted = _joints(evaluator, found.found.person.body)
    off = [_distance_cm(_joints(evaluator, each), fitted) for each in bodies]
    triangles = evaluator.model.triangles
    turned = common_camera(seen)
    panels = [coloured_body(each, triangles, turned) for each in seen]
    return Figure(
        name="figure_2",
        title="Figure 2: the first pose from clicked points",
        caption=(
            "The clicks; then the mean body of the height in the pose that they give, seen from "
            "another side, by the orthographic construction [24], by the perspective one [15], and "
            "after refinement on the clicks, with which fits begin. Joints lie "
            f"{off[0]:.1f}, {off[1]:.1f} and {off[2]:.1f} cm from those of the fitted body, root "
            "on root."
        ),
        differs=(
            "Each takes the reading of the clicks that joint limits like best. The paper shows no "
            "refinement, and does not say how it chooses."
        ),
        picture=row(
            [
                ("clicks", _with_clicks(found.pictures.image, clicks)),
                ("orthographic", panels[0]),
                ("perspective", panels[1]),
                ("refined on the clicks", panels[2]),
            ]
        ),
    )


def figure_3(result: FitResult) -> Figure:
    """The first silhouette, the tri-map and GrabCut, of a fit by the paper's method."""
    (view,) = result.views
    pictures, first = view.pictures, result.stages[0].bodies[0]
    silhouette = render(first.posed_vertices, result.triangles, view.camera).silhouette
    panels = [("first body's silhouette", tinted(pictures.image, silhouette, _SILHOUETTE))]
    if pictures.trimap is not None:
        panels.append(("tri-map", to_levels(trimap_picture(pictures.trimap))))
    mask = np.repeat(np.where(pictures.segmentation, 255, 0).astype(np.uint8)[..., None], 3, axis=2)
    panels += [
        ("GrabCut", mask),
        ("over the picture", tinted(pictures.image, pictures.segmentation, _PERSON)),
    ]
    return Figure(
        name="figure_3",
        title="Figure 3: segmentation",
        caption=(
            "The silhouette of the mean body in the first pose; the tri-map that eroding and "
            "dilating it gives; what GrabCut makes of it, alone and over the picture."
        ),
        differs=(
            "The band is 5 % of the picture's width, within 4 to 8 % of the person's size. A fit "
            "that is not by the paper's method begins with the detector's mask and cuts again."
        ),
        picture=row(panels),
    )


def _lifted_both_ways(
    evaluator: ScapeEvaluator,
    camera: Camera,
    clicks: ClickedPoints,
    shape: Shape,
    facing: Mapping[str, Facing],
) -> list[BodyParameters]:
    """The best closed-form pose by Taylor's camera and by Lee and Chen's."""
    rig = landmark_rig(evaluator.model, shape)
    prior = pose_prior(rig.part_names, rig.part_parent, rig.rest_joints)
    lengths = limb_lengths_m(rig)
    trunk = trunk_points(clicks, lengths)
    reference = reference_of(clicks, trunk, lengths)
    problem = click_problem(
        rig, prior, camera, clicks, scale=reference.scale, limb_facing=facing, slants=None
    )
    liftings: list[Lifting] = [
        OrthographicLifting(camera=camera, scale=reference.scale),
        PerspectiveLifting(camera=camera),
    ]
    bodies: list[BodyParameters] = []
    for lifting in liftings:
        starts = start_poses(
            rig,
            prior,
            lifting,
            {**clicks.by_name(), **trunk.pixels},
            lengths,
            reference.limb,
            limb_facing=facing,
            count=1,
        )
        pose = turn_head(problem, starts.pose, starts.translation)
        bodies.append(
            BodyParameters(pose=pose[0], translation=starts.translation[0], shape=shape.copy())
        )
    return bodies


def _joints(evaluator: ScapeEvaluator, body: BodyParameters) -> Points3D:
    """About the root, in the camera's axes, metres."""
    joints = regress(evaluator.model.joint_regressor, evaluator.vertices(body))
    return joints - joints[0]


def _distance_cm(first: Points3D, second: Points3D) -> float:
    return 100.0 * float(np.linalg.norm(first - second, axis=1).mean())


def _with_clicks(picture: np.ndarray, clicks: ClickedPoints) -> Levels:
    levels = to_levels(picture)
    radius = max(3, round(levels.shape[0] / 130))
    for x, y in clicks.pixels:
        at = (round(float(x) - 0.5), round(float(y) - 0.5))
        cv2.circle(levels, at, radius + 2, _HALO, -1, cv2.LINE_AA)
        cv2.circle(levels, at, radius, _CLICK, -1, cv2.LINE_AA)
    return levels
