"""Figs. 2 to 5: the first pose, the person cut out, and what outline, edges and height can tell."""

from collections.abc import Mapping
from dataclasses import replace

import cv2
import numpy as np

from fitter.arrays import Shape, Vertices
from fitter.body.pose_prior import pose_prior
from fitter.body.scape import ScapeEvaluator
from fitter.energies.edges import edge_cost_map
from fitter.energies.fitting_operators import FittingOperators
from fitter.export.display import to_levels
from fitter.export.views import coloured_body
from fitter.fits.equipment import PACKAGED, prepared_model
from fitter.fits.pipeline import fit
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
from fitter.render.contours import model_edges
from fitter.render.rasterizer import render
from fitter.reproduction.panels import (
    GREEN,
    MAGENTA,
    RED,
    Figure,
    Levels,
    common_camera,
    in_profile,
    overlaps,
    row,
    stacked,
    tinted,
)
from fitter.request import FitRequest, Paper
from fitter.result import FitResult
from fitter.segmentation.trimap import trimap_picture
from fitter.vocabulary.choices import Cues, Facing, PaperEnergy

_PROFILE_DEGREES = 70.0
_SILHOUETTE, _PERSON = (0.95, 0.75, 0.1), (0.1, 0.8, 0.3)
_CLICK, _HALO = (40, 230, 90), (0, 0, 0)
_EDGE_LINE = (230, 30, 30)
_EDGE_THRESHOLD_M = 0.03
_WITHOUT_EDGES = frozenset({PaperEnergy.SILHOUETTE, PaperEnergy.PENETRATION})


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
    triangles = evaluator.model.triangles
    turned = common_camera(seen)
    panels = [coloured_body(each, triangles, turned) for each in seen]
    return Figure(
        name="figure_2",
        title="Figure 2: the first pose from clicked points",
        caption=(
            "The clicks; then the mean body of the height in the pose that they give, seen from "
            "another side, by the orthographic construction [24], by the perspective one [15], and "
            "after refinement on the clicks, with which fits begin."
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
    assert pictures.trimap is not None, "the paper's method cuts the person out"
    mask = np.repeat(np.where(pictures.segmentation, 255, 0).astype(np.uint8)[..., None], 3, axis=2)
    panels = [
        ("first body's silhouette", tinted(pictures.image, silhouette, _SILHOUETTE)),
        ("tri-map", to_levels(trimap_picture(pictures.trimap))),
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


def _with_clicks(picture: np.ndarray, clicks: ClickedPoints) -> Levels:
    levels = to_levels(picture)
    radius = max(3, round(levels.shape[0] / 130))
    for x, y in clicks.pixels:
        at = (round(float(x) - 0.5), round(float(y) - 0.5))
        cv2.circle(levels, at, radius + 2, _HALO, -1, cv2.LINE_AA)
        cv2.circle(levels, at, radius, _CLICK, -1, cv2.LINE_AA)
    return levels


def figure_4(request: FitRequest) -> Figure:
    """Without and with the edges of the picture: of somebody part of whom hides another."""
    found = [fitted(request, Cues.SE, paper) for paper in (Paper(energies=_WITHOUT_EDGES), Paper())]
    operators = prepared_model(request.person.gender).operators
    seen = [_from_the_right(each, 60.0) for each in found]
    camera = common_camera(seen)
    titles = ("silhouette alone, from the right", "with edges, from the right")
    rows = [
        row(
            [
                ("picture", to_levels(each.views[0].pictures.image)),
                ("edge cost, the body's edges", _edges_over_cost(each, operators)),
                ("overlap", _overlap(each)),
                (title, coloured_body(body, each.triangles, camera, colour)),
            ]
        )
        for each, body, title, colour in zip(found, seen, titles, (RED, GREEN), strict=True)
    ]
    costs = [each.energies["silhouette"] for each in found]
    return Figure(
        name="figure_4",
        title="Figure 4: edges inside the silhouette",
        caption=(
            "Above, a fit by silhouette and penetration; below, by edges too. The body's edges "
            "(red) over the cost of edges of the picture (dark is cheap); the overlap of both "
            "silhouettes (yellow), with what the picture has alone (blue) and the body alone "
            f"(red); the body from the right. The silhouette costs {costs[0]:.1f} nats above and "
            f"{costs[1]:.1f} below."
        ),
        differs=(
            "Terms have the weights of this package. A rendered person in a room takes the place "
            "of the laboratory's."
        ),
        picture=stacked(rows),
    )


def figure_5(request: FitRequest, held: FitResult) -> Figure:
    """The height free and held, of the same picture; ``held`` is the fit by E1 that holds it."""
    free = fitted(request, Cues.SE, Paper(free_height=True))
    front = [each.found.posed_vertices for each in (free, held)]
    side = [_from_the_right(each, 90.0) for each in (free, held)]
    in_front, beside = common_camera(front), common_camera(side)
    panels = [("picture", to_levels(held.views[0].pictures.image))]
    for index, label, colour, result in ((0, "free", MAGENTA, free), (1, "held", GREEN, held)):
        title = f"height {label}: {100 * result.found.height_m:.0f} cm"
        panels += [
            (title, coloured_body(front[index], held.triangles, in_front, colour)),
            ("from the right", coloured_body(side[index], held.triangles, beside, colour)),
        ]
    return Figure(
        name="figure_5",
        title="Figure 5: the height, free and held",
        caption=(
            "Fits of one picture by silhouette, edges and penetration. With the height free "
            f"(magenta) the silhouettes overlap by {100 * free.found.silhouette_overlap:.1f} %, "
            f"with the height held (green) by {100 * held.found.silhouette_overlap:.1f} %: from "
            "the camera both explain the picture, from the side they differ."
        ),
        differs=(
            "Perspective ties size to distance: a taller body stands farther away. How much the "
            "bodies differ depends on the picture."
        ),
        picture=row(panels),
    )


def fitted(request: FitRequest, cues: Cues, paper: Paper | None = None) -> FitResult:
    """A fit, by the paper's method if that is given; what is doubtful is shown too."""
    return fit(
        replace(
            request,
            views=tuple(replace(view, cues=cues) for view in request.views),
            choices=replace(request.choices, paper=paper, force=True),
        )
    )


def _from_the_right(result: FitResult, degrees: float) -> Vertices:
    person = result.person
    return in_profile(
        result.found.posed_vertices, person.body.translation, person.tilt, degrees=degrees
    )


def _edges_over_cost(result: FitResult, operators: FittingOperators) -> Levels:
    (view,) = result.views
    body = view.found.person.body
    pixels_per_metre = view.camera.focal_length_px / float(body.translation[2])
    cost = edge_cost_map(
        view.pictures.image, threshold_px=_EDGE_THRESHOLD_M * pixels_per_metre
    ).cost
    levels = np.ascontiguousarray(np.repeat(to_levels(cost)[..., None], 3, axis=2))
    rendering = render(view.found.posed_vertices, result.triangles, view.camera)
    edges = model_edges(rendering, operators.topology)
    for start, end in np.rint(edges.endpoints[edges.visible] - 0.5).astype(int):
        cv2.line(levels, start.tolist(), end.tolist(), _EDGE_LINE, 2, cv2.LINE_AA)
    return levels


def _overlap(result: FitResult) -> Levels:
    (view,) = result.views
    body = render(view.found.posed_vertices, result.triangles, view.camera).silhouette
    return overlaps(body, view.pictures.segmentation)
