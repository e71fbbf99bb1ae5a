"""The body that turns on the page's first screen: the first sample's, in colour, from all around.

``python -m tests.illustrations.turning_body`` fits the sample and draws the strip of views into the
page's sources, from where its build takes it. The file is loaded before anything else of the page
is used: few views of few pixels.
"""

import json
import sys
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import UInt8

from fitter import Click, FitResult, Gender, body_vertices, fit
from fitter.applications.texture import linear_picture, picture_texture
from fitter.arrays import Triangles, Vertices
from fitter.body.scape import CAMERA_AXES
from fitter.export.display import to_levels
from fitter.export.views import turned_about_vertical
from fitter.library import PACKAGED
from fitter.observation.decoding import decode_picture
from fitter.observation.pixels import display_from_linear, linear_from_display
from fitter.parameters import CameraTilt
from fitter.person.upright import upright_rotation
from fitter.render.camera import Camera
from fitter.render.rasterizer import render, shade_image
from service.demo_data.sample import load_sample
from tests.illustrations.measurements_page import DISTANCE_M
from tests.one_picture import one_picture
from tests.unit.export.plain_pictures import block_means

FILE = Path(__file__).parents[2] / "service" / "page" / "src" / "start" / "turning.webp"

VIEWS = 18
FRAME_PX = (164, 340)
"""Width and height of a view; the page's start/turning.css says the same."""

SUPERSAMPLING = 3
ROOM_M = 1.86
FLOOR_M = 0.02
WALL = np.array([0.045, 0.040, 0.036])
"""Linear; opaque, because transparency would nearly double the file."""

QUALITY = 20

Strip = UInt8[np.ndarray, "h w 3"]


def sample_fit() -> FitResult:
    """The fit of the first sample as its request asks for it."""
    sample = load_sample()
    asked = json.loads(sample.request)
    points = asked["views"][0]["points"]
    return fit(
        one_picture(
            image=sample.image,
            clicks={name: Click(x=at["x"], y=at["y"]) for name, at in points.items()},
            gender=Gender(asked["gender"]),
            height_m=asked["height_m"],
        )
    )


def colours_of(result: FitResult) -> Vertices:
    """(m, 3) linear colours of the vertices: the sample's, with the light it was taken in.

    At a seam of the atlas a vertex has several places; they show the same.
    """
    operators = PACKAGED.model(result.person.gender).operators
    pixels = decode_picture(load_sample().image, field="image", max_pixels=10**6).pixels
    texture = picture_texture(result.person, operators.evaluator, linear_picture(pixels))
    size = len(texture.levels)
    columns, rows = np.floor(size * operators.model.uv.T).astype(int)
    found = texture.levels[size - 1 - rows, columns]
    colours = np.empty((len(result.canonical_vertices), 3))
    colours[operators.model.triangles] = found[operators.model.uv_triangles]
    return texture.scale * linear_from_display(colours / 255.0)


def strip(vertices: Vertices, triangles: Triangles, colours: Vertices) -> Strip:
    """All views side by side, the first from the front; the body turns to its left.

    Parameters
    ----------
    vertices
        (m, 3) camera frame, metres, upright.
    colours
        (m, 3) linear.
    """
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    middle[1] = vertices[:, 1].max()
    degrees = 360.0 / VIEWS * np.arange(VIEWS)
    return np.concatenate(
        [_view(vertices - middle, triangles, colours, each) for each in degrees], axis=1
    )


def upright(vertices: Vertices, tilt: CameraTilt | None) -> Vertices:
    """Vertices of the camera frame as a level camera sees them."""
    return vertices if tilt is None else vertices @ upright_rotation(tilt).T * CAMERA_AXES


def main(path: Path) -> None:
    """Write the strip."""
    result = sample_fit()
    vertices, triangles = body_vertices(result.person.gender, result.person.body)
    drawn = strip(upright(vertices, result.person.tilt), triangles, colours_of(result))
    encoded, content = cv2.imencode(".webp", drawn[:, :, ::-1], (cv2.IMWRITE_WEBP_QUALITY, QUALITY))
    if not encoded:
        message = "OpenCV could not encode the strip."
        raise RuntimeError(message)
    path.write_bytes(content.tobytes())


def _view(vertices: Vertices, triangles: Triangles, colours: Vertices, degrees: float) -> Strip:
    width, height = (SUPERSAMPLING * side for side in FRAME_PX)
    px_per_m = height / ROOM_M
    camera = Camera(
        focal_length_px=px_per_m * DISTANCE_M,
        centre_x=0.5 * width,
        centre_y=height - FLOOR_M * px_per_m,
        width=width,
        height=height,
    )
    seen = turned_about_vertical(vertices, np.zeros(3), degrees) + [0.0, 0.0, DISTANCE_M]
    rendering = render(seen, triangles, camera)
    bands = [block_means(shade_image(rendering, each), SUPERSAMPLING) for each in colours.T]
    share = block_means(rendering.silhouette.astype(np.float32), SUPERSAMPLING)
    linear = np.stack(bands, axis=2) + (1.0 - share[..., None]) * WALL
    return to_levels(display_from_linear(linear))


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FILE)
