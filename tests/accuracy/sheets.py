"""Pictures of a case's fits, after the paper's Fig. 8: bodies, outlines, errors."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Integer

from fitter.arrays import GreyImage, Triangles, Vertices
from fitter.fits.equipment import prepared_model
from fitter.render.camera import Camera
from fitter.render.rasterizer import render, shade_image
from tests.accuracy.people import packaged_model
from tests.accuracy.scoring import Fitted, resampled, working_scale

HEIGHT = 420
FULL_SCALE_MM = 50.0
TRUE_COLOUR, FOUND_COLOUR = (40, 120, 255), (60, 230, 60)
VIEWING_DISTANCE_M = 4.5
FRONT, SIDE = 0.0, 80.0

Picture = Integer[np.ndarray, "h w 3"]


def write_pictures(folder: Path, fits: Sequence[Fitted]) -> None:
    """One picture of a case's SE and SES fits, in this order: as sent, first body, both fits, the
    true body and those found from front and side, errors of vertices."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{fits[0].picture.name}.jpg"
    panels = np.hstack(list(_panels(*fits)))[..., ::-1]
    cv2.imwrite(str(path), panels, [cv2.IMWRITE_JPEG_QUALITY, 88])


def _panels(se: Fitted, ses: Fitted) -> Iterator[Picture]:
    evaluator = prepared_model(se.result.person.gender).operators.evaluator
    yield _at_height(_image(se))
    yield _outlines(se, evaluator.vertices(se.result.stages[0].bodies[0].body))
    for fitted in (se, ses):
        yield _outlines(fitted, fitted.result.found.posed_vertices)
    truth, triangles = se.picture.truth, packaged_model(se.result.person.gender).triangles
    true = _in_camera_axes(truth.canonical)
    found = [_in_camera_axes(fitted.result.canonical_vertices) for fitted in (se, ses)]
    yield _front_and_side(true, truth.triangles)
    for body in found:
        yield _front_and_side(body, triangles)
    if len(true) == len(found[0]):
        for body in found:
            yield np.hstack([_errors(true, body, triangles, angle) for angle in (FRONT, SIDE)])


def _in_camera_axes(body: Vertices) -> Vertices:
    return body * np.array([1.0, -1.0, -1.0])


def _image(fitted: Fitted) -> Picture:
    return (255.0 * fitted.result.views[0].pictures.image).astype(np.uint8)


def _outlines(fitted: Fitted, vertices: Vertices) -> Picture:
    """The true body's outline and a found one's on the picture."""
    result = fitted.result
    camera = result.views[0].camera
    true = resampled(
        fitted.picture.body_mask, 1.0 / working_scale(result), (camera.height, camera.width)
    )
    found = render(vertices, packaged_model(result.person.gender).triangles, camera).silhouette
    drawn = _image(fitted)
    for mask, colour in ((true, TRUE_COLOUR), (found, FOUND_COLOUR)):
        contours, _ = cv2.findContours(mask.astype(np.uint8), cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
        cv2.drawContours(drawn, contours, -1, colour, 1)
    return _at_height(drawn)


def _at_height(picture: Picture) -> Picture:
    width = round(picture.shape[1] * HEIGHT / picture.shape[0])
    return cv2.resize(picture, (width, HEIGHT), interpolation=cv2.INTER_AREA)


def _front_and_side(vertices: Vertices, triangles: Triangles) -> Picture:
    drawn = np.hstack([_drawn(vertices, triangles, angle, None) for angle in (FRONT, SIDE)])
    return np.repeat((255.0 * drawn).astype(np.uint8)[..., None], 3, axis=2)


def _errors(true: Vertices, found: Vertices, triangles: Triangles, angle: float) -> Picture:
    """Distances of vertices, black 0 to white at full scale, on the true body."""
    away = (found - found.mean(axis=0)) - (true - true.mean(axis=0))
    values = np.clip(1000.0 * np.linalg.norm(away, axis=1) / FULL_SCALE_MM, 0.0, 1.0)
    drawn = _drawn(true, triangles, angle, 0.98 * values)
    heat = cv2.applyColorMap((255.0 * drawn).astype(np.uint8), cv2.COLORMAP_INFERNO)[..., ::-1]
    return np.where((drawn == 1.0)[..., None], np.uint8(255), heat)


def _drawn(
    vertices: Vertices, triangles: Triangles, angle: float, values: np.ndarray | None
) -> GreyImage:
    """A body turned about the vertical, shaded or with values on it, on white."""
    turn = np.radians(angle)
    rotation = np.array(
        [[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]]
    )
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    turned = (vertices - middle) @ rotation.T + [0.0, 0.0, VIEWING_DISTANCE_M]
    width = round(0.64 * HEIGHT)
    camera = Camera(
        focal_length_px=2.1 * HEIGHT,
        centre_x=width / 2.0,
        centre_y=HEIGHT / 2.0,
        width=width,
        height=HEIGHT,
    )
    seen = render(turned, triangles, camera)
    if values is None:
        toward_light = np.array([0.4, -0.5, -0.77])
        values = 0.15 + 0.8 * np.clip(seen.vertex_normals @ toward_light, 0.0, 1.0)
    return np.where(seen.silhouette, np.nan_to_num(shade_image(seen, values)), 1.0)
