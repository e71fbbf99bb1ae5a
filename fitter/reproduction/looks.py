"""Figs. 6, 7, 9 and 10: shapes, reflectance, and what a fit is good for."""

from collections.abc import Callable
from typing import Final

import numpy as np

from fitter.applications.caricature import (
    Caricature,
    caricature_of_looks,
    caricature_of_most_unusual,
)
from fitter.applications.motion import Motion, grounded, moving_body
from fitter.applications.poses import named_pose
from fitter.applications.previews import View, preview
from fitter.applications.rig import rig_of
from fitter.applications.texture import linear_picture, picture_texture
from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES, ScapeEvaluator
from fitter.body.shape_space import height_of_shape
from fitter.errors import InvalidInputError
from fitter.export.antialiasing import render_finely, vertex_pictures
from fitter.export.display import finer, to_levels
from fitter.export.pictures import overlay_picture
from fitter.export.views import CANONICAL_DISTANCE_M, turned_about_vertical
from fitter.fits.prepared_model import prepared_model
from fitter.numerics.mesh_topology import mesh_topology
from fitter.observation.decoding import decode_picture
from fitter.parameters import BodyParameters
from fitter.render.camera import Camera
from fitter.render.rasterizer import render
from fitter.render.reflectance import shading_terms
from fitter.reproduction.panels import Figure, Levels, coloured_body, common_camera, row, stacked
from fitter.request import FitRequest
from fitter.result import FitResult
from fitter.vocabulary.choices import Gender

DEVIATIONS: Final = 3.0
_AXES: Final = 4
_ROW_PX: Final = 300

TEXTURE_SIZE: Final = 1024
_MOMENTS: Final = (0.0, 0.17, 0.42)
"""Of a motion, as shares of its length."""

_DEGREES: Final = (25.0, 60.0, -30.0)
_FACTOR: Final = 2.0
_LOOKS_FACTOR: Final = 1.7
_SAMPLES: Final = 2


def figure_6() -> Figure:
    """Three standard deviations either way: men above, women below."""
    rows, changes = [], []
    for gender in (Gender.MALE, Gender.FEMALE):
        prepared = prepared_model(gender)
        evaluator = prepared.operators.evaluator
        views: list[View] = []
        titles: list[str] = []
        for axis in range(_AXES):
            heights = []
            for sign in (-1.0, 1.0):
                shape = np.zeros(len(evaluator.model.shape_basis))
                shape[axis] = sign * DEVIATIONS
                heights.append(height_of_shape(evaluator, shape))
                title = "height axis" if axis == 0 else f"axis {axis}"
                titles.append(f"{title}: {sign * DEVIATIONS:+.0f} SD")
                views.append(
                    View(
                        label="",
                        vertices=prepared.measuring.canonical.at(shape),
                        degrees=30.0,
                    )
                )
            if axis:
                changes.append(1000.0 * abs(heights[1] - heights[0]))
        panels = np.split(preview(views, evaluator.model.triangles), len(views), axis=1)
        rows.append(row(list(zip(titles, panels, strict=True)), height_px=_ROW_PX))
    return Figure(
        name="figure_6",
        title="Figure 6: the height-preserving shape spaces",
        caption=(
            "The first pair of each row is three standard deviations either way along the height "
            "axis, the others along the first three axes that keep the height. Men above, women "
            f"below. Along those the stature changes by {max(changes):.3f} mm at most."
        ),
        differs="Learned from synthetic bodies; coefficients are whitened before axes are turned.",
        picture=stacked(rows),
    )


def figure_7(result: FitResult) -> Figure | None:
    """Albedo, and the picture's brightness by both models; None of a fit without shading."""
    person = result.person
    light, reflectance = person.light, person.reflectance
    if light is None or reflectance is None:
        return None
    (view,) = result.views
    fine = render_finely(result.found.posed_vertices, result.triangles, view.camera)
    terms = shading_terms(
        result.found.posed_vertices,
        fine.rendering.vertex_normals,
        light=light,
        body_centre=person.body.translation,
        specular_exponent=reflectance.specular_exponent,
    )
    lambertian = reflectance.ambient + reflectance.albedo * terms.diffuse
    phong = lambertian + reflectance.specularity * terms.specular
    albedo, flat, glossy = vertex_pictures([reflectance.albedo, lambertian, phong], fine)
    grey = to_levels(view.pictures.image.mean(axis=2))
    seen = np.where(view.pictures.segmentation, grey, 255).astype(np.uint8)
    return Figure(
        name="figure_7",
        title="Figure 7: estimated reflectance",
        caption=(
            "The picture's brightness, albedo, and what Eq. 1 predicts without its highlights "
            "(Lambert) and with them (Blinn-Phong)."
        ),
        differs=(
            "The specular exponent is 12 for everybody. Albedo is piecewise smooth by the same "
            "robust term."
        ),
        picture=row(
            [
                ("brightness of the picture", np.repeat(seen[..., None], 3, axis=2)),
                ("albedo", albedo),
                ("Lambert", flat),
                ("Blinn-Phong", glossy),
            ]
        ),
    )


def figure_9(request: FitRequest, result: FitResult, motion: Motion, *, recorded: bool) -> Figure:
    """Photograph, the body with its texture in poses of a motion, and a caricature.

    ``recorded`` says that the motion is motion capture, not the package's own walk.
    """
    person, evaluator = result.person, prepared_model(request.person.gender).operators.evaluator
    model = evaluator.model
    pixels = decode_picture(
        request.views[0].image, field="image", max_pixels=request.choices.max_pixels
    ).pixels
    texture = picture_texture(
        person, evaluator, linear_picture(pixels), mask=None, size=TEXTURE_SIZE
    )
    body = grounded(moving_body(evaluator, person.body.shape, motion), model)
    frames = [min(round(share * len(body.shapes)), len(body.shapes) - 1) for share in _MOMENTS]
    seen = [
        _before_camera(body.vertices(frame), degrees)
        for frame, degrees in zip(frames, _DEGREES, strict=True)
    ]
    camera = common_camera(seen)
    titles = [f"at {frame * motion.frame_time_s:.2f} s" for frame in frames]
    panels = [
        (title, textured_body(each, model, texture.levels, camera))
        for title, each in zip(titles, seen, strict=True)
    ]
    shape, canonical = person.body.shape, prepared_model(person.gender).measuring.canonical
    one = _exaggerated(caricature_of_most_unusual, evaluator, shape, _FACTOR)
    looks = _exaggerated(caricature_of_looks, evaluator, shape, _LOOKS_FACTOR)
    resting = [_before_camera(canonical.at(each), 30.0) for each in (shape, one.shape, looks.shape)]
    at_rest = common_camera(resting)
    plain, changed, whole = (coloured_body(each, model.triangles, at_rest) for each in resting)
    return Figure(
        name="figure_9",
        title="Figure 9: new poses and a caricature",
        caption=(
            "The picture; the fitted body with the picture's texture at moments of "
            f"{'a recorded motion' if recorded else 'a walk'}; the body; the same with its most "
            f"unusual coefficient, number {one.coefficient}, multiplied by {one.factor:g}, as in "
            f"the paper; and with all but the height's multiplied by {looks.factor:g}. "
            f"{100 * texture.seen_share:.0f} % of the texture were seen, the rest was mirrored or "
            "continued."
        ),
        differs=(
            "One coefficient that deviates most often hardly shows, so that all are exaggerated "
            "too."
            + (
                ""
                if recorded
                else " The walk is drawn from published curves of gait; motion capture is taken "
                "as a BVH file."
            )
        ),
        picture=row(
            [
                ("picture", to_levels(result.views[0].pictures.image)),
                *panels,
                ("fitted", plain),
                (f"one coefficient times {one.factor:g}", changed),
                (f"all times {looks.factor:g}", whole),
            ]
        ),
    )


def figure_10(request: FitRequest, result: FitResult, *, pose: str = "walking") -> Figure:
    """Painting, overlay, shape, and shape in a new pose."""
    evaluator = prepared_model(request.person.gender).operators.evaluator
    model, (view,) = evaluator.model, result.views
    levels = to_levels(view.pictures.image)
    topology = mesh_topology(model.triangles, vertex_count=len(model.mean_vertices))
    shape = result.person.body.shape
    fitted, reposed = (
        evaluator.body_frame_vertices(
            BodyParameters(pose=each, translation=np.zeros(3), shape=shape)
        )
        for each in (result.person.body.pose, named_pose(rig_of(model, shape), pose))
    )
    overlay = overlay_picture(
        levels, result.found.posed_vertices, model.triangles, topology, view.camera
    )
    bodies = preview(
        [View(label="", vertices=fitted), View(label="", vertices=reposed)], model.triangles
    )
    one, other = np.split(bodies, 2, axis=1)
    return Figure(
        name="figure_10",
        title="Figure 10: a painting",
        caption=(
            "The painting, the fitted body over it, the body as it was recovered, and in another "
            f"pose. Fitted with {result.found.cues.value}; the silhouettes overlap by "
            f"{100 * result.found.silhouette_overlap:.0f} %."
        ),
        differs="The painting is the one that was given.",
        picture=row(
            [
                ("picture", levels),
                ("fitted body over it", overlay),
                ("fitted body", one),
                (pose.replace("_", " "), other),
            ]
        ),
    )


def textured_body(vertices: Vertices, model: BodyModel, texture: Levels, camera: Camera) -> Levels:
    """A body with its texture before white paper, as it is: unlit.

    The point of a triangle with corners v₁ v₂ v₃ that a pixel's ray d meets has barycentric
    coordinates in proportion to [v₁ v₂ v₃]⁻¹ d.

    Parameters
    ----------
    vertices
        (m, 3) in the camera's frame, metres.
    texture
        (n, n, 3) levels of the model's atlas.
    """
    fine = finer(camera, _SAMPLES)
    rendering = render(vertices, model.triangles, fine)
    ids = rendering.face_ids
    rows, columns = np.nonzero(ids >= 0)
    faces = ids[rows, columns]
    rays = np.stack(
        [
            (columns + 0.5 - fine.centre_x) / fine.focal_length_px,
            (rows + 0.5 - fine.centre_y) / fine.focal_length_px,
            np.ones(len(rows)),
        ],
        axis=1,
    )
    corners = np.swapaxes(vertices[model.triangles[faces]], 1, 2)
    weights = np.linalg.solve(corners, rays[..., None])[..., 0]
    weights /= weights.sum(axis=1, keepdims=True)
    uv = np.einsum("pk,pkc->pc", weights, model.uv[model.uv_triangles[faces]])
    size = len(texture)
    texels = np.clip((np.stack([1.0 - uv[:, 1], uv[:, 0]]) * size).astype(int), 0, size - 1)
    levels = np.full((*ids.shape, 3), 255, dtype=np.float64)
    levels[rows, columns] = texture[texels[0], texels[1]]
    height, width = camera.height, camera.width
    blocks = levels.reshape(height, _SAMPLES, width, _SAMPLES, 3)
    return np.rint(blocks.mean(axis=(1, 3))).astype(np.uint8)


def _exaggerated(
    exaggerate: Callable[[ScapeEvaluator, Shape, float], Caricature],
    evaluator: ScapeEvaluator,
    shape: Shape,
    factor: float,
) -> Caricature:
    """By this factor, or by the largest with which the surface stays sound."""
    try:
        return exaggerate(evaluator, shape, factor)
    except InvalidInputError as error:
        if error.largest is None:
            raise
        return exaggerate(evaluator, shape, error.largest)


def _before_camera(vertices: Vertices, degrees: float) -> Vertices:
    """A body of the body frame as somebody sees it who walked round it."""
    there = np.array([0.0, 0.0, CANONICAL_DISTANCE_M])
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    return turned_about_vertical(
        (vertices - 0.5 * (low + high)) * CAMERA_AXES + there, there, degrees
    )
