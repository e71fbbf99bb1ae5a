"""A motion for people looking at it: a strip of moments, and a small film."""

import io

import numpy as np
from jaxtyping import UInt8
from PIL import Image as PillowImage

from fitter.applications.motion import MovingBody
from fitter.arrays import Triangles, Vertices
from fitter.body.scape import CAMERA_AXES
from fitter.export.views import (
    CANONICAL_DISTANCE_M,
    clay_panel,
    framing_camera,
    turned_about_vertical,
)
from fitter.render.camera import Camera

MOMENTS = 8

STRIP_PANEL_PX = (260, 380)
"""Width and height."""

FILM_PANEL_PX = (300, 400)

FILM_FRAMES_PER_SECOND = 15.0
MOST_FILM_FRAMES = 120

FILM_DEGREES = 40.0
"""From where the film is seen: between the front and the person's left."""

_QUALITY = 70
_EYE_LEVEL_M = 0.9


def strip(body: MovingBody, triangles: Triangles) -> UInt8[np.ndarray, "h w 3"]:
    """Moments of a motion at even distances in time, from the front above and the side below."""
    chosen = np.unique(np.linspace(0, len(body.shapes) - 1, MOMENTS).round().astype(int)).tolist()
    rows: list[np.ndarray] = []
    for degrees in (0.0, 90.0):
        bodies = [_seen(body, frame, degrees) for frame in chosen]
        camera = _camera(bodies, STRIP_PANEL_PX)
        labels = [f"{frame * body.motion.frame_time_s:.2f} s" for frame in chosen]
        panels = [
            clay_panel(vertices, triangles, label, camera)
            for vertices, label in zip(bodies, labels, strict=True)
        ]
        rows.append(np.concatenate(panels, axis=1))
    return np.concatenate(rows)


def film(body: MovingBody, triangles: Triangles) -> bytes:
    """An animated WebP that follows the person, again and again; at most 15 frames a second."""
    frame_time_s = body.motion.frame_time_s
    step = max(
        1,
        round(1.0 / (FILM_FRAMES_PER_SECOND * frame_time_s)),
        -(-len(body.shapes) // MOST_FILM_FRAMES),
    )
    chosen = range(0, len(body.shapes), step)
    camera = _camera([_seen(body, frame, FILM_DEGREES) for frame in chosen[::4]], FILM_PANEL_PX)
    pictures = [
        PillowImage.fromarray(clay_panel(_seen(body, frame, FILM_DEGREES), triangles, "", camera))
        for frame in chosen
    ]
    stream = io.BytesIO()
    pictures[0].save(
        stream,
        format="WEBP",
        save_all=True,
        append_images=pictures[1:],
        duration=round(1000.0 * step * frame_time_s),
        loop=0,
        quality=_QUALITY,
    )
    return stream.getvalue()


def _seen(body: MovingBody, frame: int, degrees: float) -> Vertices:
    """A frame before a camera that goes along with the person."""
    there = np.array([0.0, 0.0, CANONICAL_DISTANCE_M])
    along = np.array([body.roots[frame, 0], _EYE_LEVEL_M, body.roots[frame, 2]])
    return turned_about_vertical(
        (body.vertices(frame) - along) * CAMERA_AXES + there, there, degrees
    )


def _camera(bodies: list[Vertices], size: tuple[int, int]) -> Camera:
    """One camera for all of them."""
    width, height = size
    return framing_camera(np.concatenate(bodies), width=width, height=height)
