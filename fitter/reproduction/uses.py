"""Figs. 9 and 10: what a fit is good for: new poses with the picture's texture, a caricature."""

from collections.abc import Callable
from typing import Final

import numpy as np

from fitter.applications.caricature import (
    Caricature,
    caricature_of_looks,
    caricature_of_most_unusual,
)
from fitter.applications.figure import figure_picture
from fitter.applications.grounding import grounded
from fitter.applications.motion import Motion, moving_body
from fitter.applications.poses import named_pose
from fitter.applications.rig import rig_of
from fitter.applications.texture import linear_picture, picture_texture
from fitter.arrays import Shape, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import CAMERA_AXES, ScapeEvaluator
from fitter.errors import InvalidInputError
from fitter.export.display import finer, to_levels
from fitter.export.pictures import overlay_picture
from fitter.export.views import CANONICAL_DISTANCE_M, turned_about_vertical
from fitter.fits.prepared_model import prepared_model
from fitter.numerics.mesh_topology import mesh_topology
from fitter.observation.decoding import decode_picture
from fitter.parameters import BodyParameters
from fitter.render.camera import Camera
from fitter.render.rasterizer import render
from fitter.reproduction.figure import Figure
from fitter.reproduction.panels import Levels, coloured_body, common_camera, row
from fitter.request import FitRequest
from fitter.result import FitResult

TEXTURE_SIZE: Final = 1024
_MOMENTS: Final = (0.0, 0.17, 0.42)
"""Of a motion, as shares of its length."""

_DEGREES: Final = (25.0, 60.0, -30.0)
_FACTOR: Final = 2.0
_LOOKS_FACTOR: Final = 1.7
_SAMPLES: Final = 2


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
    return Figure(
        name="figure_10",
        title="Figure 10: a painting",
        caption=(
            "The painting, the fitted body over it, the body as it was recovered, and in another "
            f"pose. Fitted with {result.found.cues.value}; the silhouettes overlap by "
            f"{100 * result.found.silhouette_overlap:.0f} %."
        ),
        differs="The painting is the one that was given.",
        picture=figure_picture(
            levels,
            overlay_picture(
                levels, result.found.posed_vertices, model.triangles, topology, view.camera
            ),
            fitted,
            reposed,
            model.triangles,
            pose_name=pose.replace("_", " "),
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
