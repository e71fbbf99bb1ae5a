"""A sheet of pictures for each fit, after the paper's Fig. 8: picture, overlay, bodies, errors."""

from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Integer

from fitter.arrays import GreyImage, Vertices
from fitter.camera import Camera
from fitter.render.interpolation import shade_image
from fitter.render.rasterizer import render
from tests.evaluation.files import read_case
from tests.evaluation.landmark_points import packaged_model
from tests.evaluation.suite import Scored, resampled, working_scale

HEIGHT = 560
FULL_SCALE_MM = 50.0
TRUE_COLOUR, FOUND_COLOUR = (40, 120, 255), (60, 230, 60)
VIEWING_DISTANCE_M = 4.5

Picture = Integer[np.ndarray, "h w 3"]


def write_sheet(folder: Path, scored: Scored) -> None:
    """Picture, outlines (true body, fit), fit from the side, canonical truth and fit, errors."""
    folder.mkdir(parents=True, exist_ok=True)
    posed = scored.result.posed_vertices
    true, found = (
        body * np.array([1.0, -1.0, -1.0])
        for body in (scored.truth.canonical, scored.result.canonical_vertices)
    )
    above = [_outlines(scored)]
    above += [_grey(scored, posed, angle) for angle in (0.0, 60.0, -75.0)]
    below = [_grey(scored, body, angle) for angle in (0.0, 80.0) for body in (true, found)]
    below += [_errors(scored, true, found, angle) for angle in (0.0, 80.0)]
    rows = [np.hstack(panels) for panels in (above, below)]
    widest = max(row.shape[1] for row in rows)
    to_right = [((0, 0), (0, widest - row.shape[1]), (0, 0)) for row in rows]
    sheet = np.vstack(
        [np.pad(row, pad, constant_values=255) for row, pad in zip(rows, to_right, strict=True)]
    )
    path = folder / f"{scored.case.name}_{scored.cues.value}.png"
    cv2.imwrite(str(path), sheet[..., ::-1])


def _outlines(scored: Scored) -> Picture:
    image = (255.0 * scored.result.pictures.image).astype(np.uint8)
    camera = scored.result.camera
    true = resampled(
        read_case(scored.case).body_mask,
        1.0 / working_scale(scored.result),
        (camera.height, camera.width),
    ).astype(np.uint8)
    triangles = packaged_model(scored.result.gender).triangles
    found = render(scored.result.posed_vertices, triangles, camera).silhouette.astype(np.uint8)
    drawn = image.copy()
    for mask, colour in ((true, TRUE_COLOUR), (found, FOUND_COLOUR)):
        contours, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
        cv2.drawContours(drawn, contours, -1, colour, 1)
    both = np.hstack([image, drawn])
    width = round(both.shape[1] * HEIGHT / both.shape[0])
    return cv2.resize(both, (width, HEIGHT), interpolation=cv2.INTER_AREA)


def _grey(scored: Scored, vertices: Vertices, angle: float) -> Picture:
    drawn = _drawn(scored, vertices, angle, None)
    return np.repeat((255.0 * drawn).astype(np.uint8)[..., None], 3, axis=2)


def _errors(scored: Scored, true: Vertices, found: Vertices, angle: float) -> Picture:
    """Distances of vertices, black 0 to white at full scale, on the true body."""
    away = (found - found.mean(axis=0)) - (true - true.mean(axis=0))
    values = np.clip(1000.0 * np.linalg.norm(away, axis=1) / FULL_SCALE_MM, 0.0, 1.0)
    drawn = _drawn(scored, true, angle, 0.98 * values)
    heat = cv2.applyColorMap((255.0 * drawn).astype(np.uint8), cv2.COLORMAP_INFERNO)[..., ::-1]
    return np.where((drawn == 1.0)[..., None], np.uint8(255), heat)


def _drawn(
    scored: Scored, vertices: Vertices, angle: float, values: np.ndarray | None
) -> GreyImage:
    """A body turned about the vertical, shaded or with values on it, on white."""
    turn = np.radians(angle)
    rotation = np.array(
        [[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]]
    )
    turned = (vertices - vertices.mean(axis=0)) @ rotation.T + [0.0, 0.0, VIEWING_DISTANCE_M]
    width = round(0.55 * HEIGHT)
    camera = Camera(
        focal_length_px=2.1 * HEIGHT,
        centre_x=width / 2.0,
        centre_y=HEIGHT / 2.0,
        width=width,
        height=HEIGHT,
    )
    seen = render(turned, packaged_model(scored.result.gender).triangles, camera)
    if values is None:
        toward_light = np.array([0.4, -0.5, -0.77])
        values = 0.15 + 0.8 * np.clip(seen.vertex_normals @ toward_light, 0.0, 1.0)
    return np.where(seen.silhouette, np.nan_to_num(shade_image(seen, values)), 1.0)
