"""The moving picture that README and documentation begin with, made from the first sample.

``python -m tests.illustrations.moving_picture`` fits the sample as its request asks for it and
writes ``service/demo_data/moving.webp``: the photograph, tapes on it with what they measure, and
the body that walks, in the photograph's colours.
"""

import io
import sys
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
from jaxtyping import Float
from PIL import Image, ImageDraw, ImageFont, ImageSequence
from scipy.spatial import KDTree
from trimesh.registration import procrustes

from fitter import FitResult, body_vertices
from fitter.applications.animation import animate, motion_of_walk
from fitter.applications.poses import rig_of
from fitter.applications.texture import linear_picture, picture_texture
from fitter.export.gltf_mesh import BodyTexture
from fitter.library import PACKAGED
from fitter.measurement.anthropometry import tape_lines
from fitter.measurement.definitions import INTERVAL_SD
from fitter.observation.decoding import decode_picture
from fitter.render.rasterizer import Rendering, render
from service.demo_data.sample import FOLDER, load_sample
from tests.illustrations.turning_body import sample_fit

FILE = FOLDER / "moving.webp"
SIZE_PX = (360, 480)
TAPES = {
    "chest_girth": "Chest",
    "waist_girth_smallest": "Waist",
    "hip_girth": "Hip",
}
INK = (255, 255, 255)
LINE = (255, 120, 40)
NEIGHBOURS = 24
FONT = ImageFont.load_default(26)
BEHIND = 0.01
"""A point of a tape that is farther by this share than what is seen there is behind the body."""


def with_tapes(result: FitResult, photograph: Image.Image) -> Iterator[Image.Image]:
    """The photograph with one tape more each time."""
    prepared = PACKAGED.model(result.person.gender)
    lines = tape_lines(prepared.measuring, result.person.body.shape)
    values = {each.name: each for each in result.measurements}
    vertices, triangles = body_vertices(result.person.gender, result.person.body)
    rendering = render(vertices, triangles, result.person.camera)
    near = KDTree(result.canonical_vertices)
    picture = photograph.copy()
    for name, label in TAPES.items():
        # Where the skin around each point of the tape went when the body was posed.
        around = near.query(lines[name], NEIGHBOURS)[1]
        moves = [
            procrustes(result.canonical_vertices[some], vertices[some], scale=False)[0]
            for some in around
        ]
        points = np.column_stack([lines[name], np.ones(len(around))])
        posed = np.einsum("kij,kj->ki", np.array(moves)[:, :3], points)
        measured = values[name]
        half = INTERVAL_SD * (measured.standard_error or 0.0)
        draw_tape(picture, posed, rendering, f"{label} {measured.value:.0f} \u00b1 {half:.0f} cm")
        yield picture.copy()


def draw_tape(
    picture: Image.Image, line: Float[np.ndarray, "k 3"], rendering: Rendering, label: str
) -> None:
    """Draw what is seen of a line in the camera's frame, with a label beside its right end."""
    camera = rendering.camera
    pixels = camera.project(line)
    columns, rows = np.floor(pixels.T).astype(int)
    seen = line[:, 2] * rendering.inverse_depth[rows, columns] < 1.0 + BEHIND
    pen = ImageDraw.Draw(picture)
    for k in range(len(line) - 1):
        if seen[k] and seen[k + 1]:
            pen.line([*map(tuple, pixels[k : k + 2])], fill=LINE, width=4)
    right = pixels[seen][pixels[seen][:, 0].argmax()]
    pen.text(
        right + [14, 0], label, fill=INK, anchor="lm", font=FONT, stroke_width=3, stroke_fill=0
    )


def film(result: FitResult) -> Image.Image:
    """The walk in the photograph's colours."""
    operators = PACKAGED.model(result.person.gender).operators
    pixels = decode_picture(load_sample().image, field="image", max_pixels=10**6).pixels
    texture = picture_texture(result.person, operators.evaluator, linear_picture(pixels))
    walk = motion_of_walk(rig_of(operators.model, result.person.body.shape))
    _, encoded = cv2.imencode(".png", texture.levels[:, :, ::-1])
    made = animate(
        result.person,
        operators.evaluator,
        walk,
        texture=BodyTexture.of(
            operators.model, encoded.tobytes(), media_type="image/png", is_lit=True
        ),
    )
    return Image.open(io.BytesIO(made.files["animation.webp"]))


def main(path: Path = FILE) -> None:
    """Write the picture."""
    result = sample_fit()
    photograph = Image.open(io.BytesIO(load_sample().image)).convert("RGB")
    measured = list(with_tapes(result, photograph))
    walk = film(result)
    steps = [frame.convert("RGB") for frame in ImageSequence.Iterator(walk)]
    frames = [photograph, *measured, *steps]
    durations = [
        1000,
        *([500] * (len(measured) - 1)),
        1800,
        *([walk.info["duration"]] * len(steps)),
    ]
    small = [frame.resize(SIZE_PX, Image.Resampling.LANCZOS) for frame in frames]
    small[0].save(
        path, save_all=True, append_images=small[1:], duration=durations, loop=0, quality=55
    )


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
