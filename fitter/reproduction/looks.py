"""Figs. 6, 7, 9 and 10: shapes, reflectance, and what a fit is good for."""

from dataclasses import replace
from typing import Final

import numpy as np

from fitter.applications.caricature import caricature_of_most_unusual
from fitter.applications.motion import grounded, motion_of_cycle, moving_body
from fitter.applications.poses import named_pose, rig_of
from fitter.applications.texture import linear_picture, picture_texture
from fitter.applications.walk import stride_of
from fitter.arrays import Vertices
from fitter.body.model import BodyModel
from fitter.export.bundle import reflectance_pictures
from fitter.export.display import finer, to_levels
from fitter.export.gltf_mesh import BodyTexture
from fitter.export.pictures import overlay_picture
from fitter.export.views import BodyView, before_onlooker, coloured_body, middle_of, preview
from fitter.fits.equipment import prepared_model
from fitter.numerics.meshes import mesh_topology
from fitter.observation.decoding import decode_picture
from fitter.render.camera import Camera
from fitter.render.rasterizer import render, shade_image
from fitter.reproduction.panels import Figure, Levels, common_camera, row, stacked
from fitter.request import FitRequest
from fitter.result import FitResult
from fitter.vocabulary.choices import Gender

DEVIATIONS: Final = 3.0
_AXES: Final = 4
_ROW_PX: Final = 300

TEXTURE_SIZE: Final = 1024
_MOMENTS: Final = (0.0, 0.17, 0.42)
"""Moments of a motion, as shares of its length."""

_DEGREES: Final = (25.0, 60.0, -30.0)
_FACTOR: Final = 2.0
_SAMPLES: Final = 2


def figure_6() -> Figure:
    """Three standard deviations either way: men above, women below."""
    rows: list[Levels] = []
    for gender in (Gender.MALE, Gender.FEMALE):
        prepared = prepared_model(gender)
        evaluator = prepared.operators.evaluator
        views: list[BodyView] = []
        titles: list[str] = []
        for axis in range(_AXES):
            shapes = np.zeros((2, len(evaluator.model.shape_basis)))
            shapes[:, axis] = -DEVIATIONS, DEVIATIONS
            for shape in shapes:
                title = "height axis" if axis == 0 else f"axis {axis}"
                titles.append(f"{title}: {shape[axis]:+.0f} SD")
                at_rest = prepared.measuring.canonical.at(shape)
                views.append(BodyView(label="", vertices=at_rest, degrees=30.0))
        panels = np.split(preview(views, evaluator.model.triangles), len(views), axis=1)
        rows.append(row(list(zip(titles, panels, strict=True)), height_px=_ROW_PX))
    return Figure(
        name="figure_6",
        title="Figure 6: the height-preserving shape spaces",
        caption=(
            "The first pair of each row is three standard deviations either way along the height "
            "axis, the others along the first three axes that keep the height. Men above, women "
            "below."
        ),
        differs="Learned from synthetic bodies; coefficients are whitened before axes are turned.",
        picture=stacked(rows),
    )


def figure_7(result: FitResult) -> Figure:
    """Albedo, and the picture's brightness by both models, of a fit with shading."""
    (view,) = result.views
    model = prepared_model(result.person.gender).operators.model
    drawn = reflectance_pictures(result.found, model)
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
            "robust term, and shown in colour."
        ),
        picture=row(
            [
                ("brightness of the picture", np.repeat(seen[..., None], 3, axis=2)),
                ("albedo", drawn["albedo.png"]),
                ("Lambert", drawn["shading_lambertian.png"]),
                ("Blinn-Phong", drawn["shading.png"]),
            ]
        ),
    )


def figure_9(request: FitRequest, result: FitResult) -> Figure:
    """Photograph, the body with its texture in poses of a walk, and a caricature."""
    person, evaluator = result.person, prepared_model(request.person.gender).operators.evaluator
    model, shape = evaluator.model, person.body.shape
    pixels = decode_picture(
        request.views[0].image, field="image", max_pixels=request.choices.max_pixels
    ).pixels
    texture = picture_texture(
        person, evaluator, linear_picture(pixels), mask=None, size=TEXTURE_SIZE
    )
    rig = rig_of(model, shape)
    motion = motion_of_cycle(stride_of(rig), rig)
    body = grounded(moving_body(evaluator, shape, motion), model)
    frames = [round(share * len(body.shapes)) for share in _MOMENTS]
    seen = [
        _turned(body.vertices(frame), degrees)
        for frame, degrees in zip(frames, _DEGREES, strict=True)
    ]
    camera = common_camera(seen)
    moments = [
        (
            f"at {frame * motion.frame_time_s:.2f} s",
            textured_body(each, model, texture.levels, camera),
        )
        for frame, each in zip(frames, seen, strict=True)
    ]
    one = caricature_of_most_unusual(evaluator, shape, _FACTOR)
    canonical = prepared_model(person.gender).measuring.canonical
    resting = [_turned(canonical.at(each), 30.0) for each in (shape, one.shape)]
    at_rest = common_camera(resting)
    plain, changed = (coloured_body(each, model.triangles, at_rest) for each in resting)
    return Figure(
        name="figure_9",
        title="Figure 9: new poses and a caricature",
        caption=(
            "The picture; the fitted body with the picture's texture at moments of a walk; the "
            f"body; the same with its most unusual coefficient, number {one.coefficient}, "
            f"multiplied by {_FACTOR:g}. {100 * texture.seen_share:.0f} % of the texture were "
            "seen, the rest was mirrored or continued."
        ),
        differs="The walk is drawn from published curves of gait; one coefficient hardly shows.",
        picture=row(
            [
                ("picture", to_levels(result.views[0].pictures.image)),
                *moments,
                ("fitted", plain),
                (f"one coefficient times {_FACTOR:g}", changed),
            ]
        ),
    )


def figure_10(request: FitRequest, result: FitResult) -> Figure:
    """Painting, overlay, shape, and shape in a new pose."""
    evaluator = prepared_model(request.person.gender).operators.evaluator
    model, (view,) = evaluator.model, result.views
    levels = to_levels(view.pictures.image)
    topology = mesh_topology(model.triangles, vertex_count=len(model.mean_vertices))
    body = result.person.body
    rig = rig_of(model, body.shape)
    bodies = [replace(body, pose=each) for each in (body.pose, named_pose(rig, "walking"))]
    seen = [_turned(evaluator.body_frame_vertices(each), 0.0) for each in bodies]
    camera = common_camera(seen)
    fitted, walking = (coloured_body(each, model.triangles, camera) for each in seen)
    overlay = overlay_picture(
        levels, result.found.posed_vertices, model.triangles, topology, view.camera
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
        picture=row(
            [
                ("picture", levels),
                ("fitted body over it", overlay),
                ("fitted body", fitted),
                ("walking", walking),
            ]
        ),
    )


def textured_body(vertices: Vertices, model: BodyModel, texture: Levels, camera: Camera) -> Levels:
    """A body with its texture before white paper, as it is: unlit.

    Parameters
    ----------
    vertices
        (m, 3) in the camera's frame, metres.
    texture
        (n, n, 3) levels of the model's atlas.
    """
    cut = BodyTexture.of(model, b"", media_type="image/png", is_lit=True)
    rendering = render(vertices[cut.owners], cut.triangles, finer(camera, _SAMPLES))
    columns, rows = (shade_image(rendering, along) for along in cut.texels.T)
    last = len(texture) - 1
    texels = np.clip(np.stack([rows, columns]) * len(texture), 0, last).astype(int)
    shown = (rendering.face_ids >= 0)[..., None]
    levels = np.where(shown, texture[texels[0], texels[1]], 255.0)
    blocks = levels.reshape(camera.height, _SAMPLES, camera.width, _SAMPLES, 3)
    return np.rint(blocks.mean(axis=(1, 3))).astype(np.uint8)


def _turned(vertices: Vertices, degrees: float) -> Vertices:
    return before_onlooker(vertices, middle_of(vertices), degrees)
