"""MEASUREMENTS.md and its pictures: what is measured, and how that stands to standard and survey.

``python -m tests.illustrations.measurements_page`` makes the page of the definitions, and draws the
tape of each measurement on the mean woman into ``fitter/measurement/atlas``, one sheet a group. A
tape is seen from where most of it is; what the body hides of it is thin.
"""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from jaxtyping import Bool, Float, UInt8

from fitter.arrays import Points2D, Points3D, Triangles, Vertices
from fitter.body.scape import CAMERA_AXES, ScapeEvaluator
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.export.display import to_levels
from fitter.export.views import turned_about_vertical
from fitter.measurement.anthropometry import measuring_body, tape_lines
from fitter.measurement.definitions import (
    DEFINITIONS_PATH,
    Extent,
    Height,
    Length,
)
from fitter.observation.pixels import display_from_linear
from fitter.render.camera import Camera
from fitter.render.rasterizer import Rendering, render, shade_image
from fitter.vocabulary.measurements import Group, group_of

ROOT = Path(__file__).parents[2]

_HEADING = """# Measurements

Every measurement of the service, where its tape runs, its definition, and where it agrees with two
others: ISO 8559-1:2017, the tailors' standard, and ANSUR II, the US Army's survey of 2012 (fields
of the public release, NATICK/TR-15/007). What the survey's handbook says of each stands in
`fitter/measurement/definitions.json`, from which `python -m tests.illustrations.measurements_page`
makes this page.

Bodies are measured in the canonical pose (upright, arms 40 and legs 7 degrees from straight down,
elbows and knees straight), heights in the standing pose, limbs on the right. A girth is the convex
hull of a plane cut, because a tape spans hollows; it does not press. Where no landmark is, a point
is where a ray from inside the average body leaves the skin.

The pictures show the average woman; what she hides of a tape is pale. `python -m fitter.training
report` prints how far values, spreads and correlations are from the survey's.
"""

ATLAS_FOLDER = "fitter/measurement/atlas"
"""From the page, at the root of the repository: a picture of each group's tapes on the body."""

_AGREEMENT = {"same": "As there", "differs": "Differs"}


def sheet_name(group: Group) -> str:
    """The file of a group's picture."""
    return f"{group.name.lower()}.webp"


def described() -> list[dict[str, Any]]:
    """The measurements as their file describes them."""
    return json.loads(DEFINITIONS_PATH.read_text(encoding="utf-8"))["measurements"]


def measurements_page() -> str:
    """The page, in Markdown."""
    lines = [_HEADING]
    for group in Group:
        members = [each for each in described() if group_of(each["name"]) is group]
        lines += [
            f"## {group.value}\n",
            f"![Each tape on the body, under its name]({ATLAS_FOLDER}/{sheet_name(group)})\n",
            "| measurement | here | ISO 8559-1 | ANSUR II |",
            "|---|---|---|---|",
            *(_row(each) for each in members),
            "",
        ]
    return "\n".join(lines).rstrip("\n") + "\n"


def _row(entry: Mapping[str, Any]) -> str:
    iso, survey = entry.get("iso"), entry["survey"]
    fields = " + ".join(f"`{field}`" for field in survey["fields"])
    return (
        f"| `{entry['name']}` ({entry['unit']}) | {entry['definition']} | "
        f"{'-' if iso is None else _compared(iso['term'] + _clause(iso), iso)} | "
        f"{_compared(fields, survey) if fields else '-'} |"
    )


def _clause(iso: Mapping[str, Any]) -> str:
    return f" ({iso['clause']})" if "clause" in iso else ""


def _compared(there: str, other: Mapping[str, Any]) -> str:
    return f"{there}. *{_AGREEMENT[other['agreement']]}:* {other['difference']}"


GENDER = "female"

VIEWS_DEGREES = (0.0, -90.0, 180.0, -40.0)
"""From the front, from the right, from behind, and half from the right."""

PREFERENCE = 1.03
"""A later view must show so much more of a tape than an earlier one."""

DISTANCE_M = 200.0
"""From so far away the picture is parallel to a thousandth."""

TO_LIGHT = np.array([-0.55, -0.52, -0.65])
FILL_LIGHT = 0.14
CLAY = np.array([0.62, 0.53, 0.47])

PX_PER_M = 1000.0
ROOM_M = (1.3, 1.8)
"""Width and height of what a view shows."""

CELL_PX = (220, 240)
LABEL_PX = 18
COLUMNS = 6
LEAST_M = 0.42
"""Height of the smallest detail."""

MARGIN = 1.25
STEP_M = 0.002
HIDDEN_M = 0.012
"""A point of a tape this far behind the skin is hidden: a taut tape touches it or lies outside."""

TAPE = (200, 30, 40)
HIDDEN_TAPE = (230, 130, 130)
INK = (50, 50, 50)
WEBP_QUALITY = 82

Levels = UInt8[np.ndarray, "h w 3"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _View:
    """The body from one side, drawn once; tapes are placed on details of it."""

    degrees: float
    rendering: Rendering
    picture: Levels

    def project(self, points: Points3D) -> tuple[Points2D, Float[np.ndarray, " k"]]:
        """Pixels of points of the body frame, feet on the floor, and their depth."""
        seen = _seen(points, self.degrees)
        camera = self.rendering.camera
        flat = camera.focal_length_px * seen[:, :2] / seen[:, 2:]
        return flat + [camera.centre_x, camera.centre_y], seen[:, 2]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class _Tape:
    """Points every few millimetres along a tape; ``inside`` if it may run through the body."""

    name: str
    points: Points3D
    inside: bool


def atlas_sheets() -> Mapping[Group, Levels]:
    """A sheet of each group whose measurements have tapes, in the order of the definitions."""
    model = load_body_model(packaged_model_path(GENDER))
    body = measuring_body(model, ScapeEvaluator(model))
    shape = np.zeros(len(model.shape_basis))
    vertices = body.canonical.at(shape)
    floor = np.array([0.0, vertices[:, 1].min(), 0.0])
    views = [_view(vertices - floor, model.triangles, degrees) for degrees in VIEWS_DEGREES]
    cells: dict[Group, list[Levels]] = {}
    straight = {d.about.name for d in body.definitions if isinstance(d, Length | Height | Extent)}
    for name, line in tape_lines(body, shape).items():
        tape = _Tape(name=name, points=_dense(line - floor), inside=name in straight)
        cells.setdefault(group_of(name), []).append(_cell(tape, views))
    return {group: _sheet(found) for group, found in cells.items()}


def main() -> None:
    """Write the page and the sheets."""
    (ROOT / "MEASUREMENTS.md").write_text(measurements_page(), encoding="utf-8")
    for group, levels in atlas_sheets().items():
        encoded, content = cv2.imencode(
            ".webp", levels[:, :, ::-1], (cv2.IMWRITE_WEBP_QUALITY, WEBP_QUALITY)
        )
        assert encoded
        (ROOT / ATLAS_FOLDER / sheet_name(group)).write_bytes(content.tobytes())


def _view(vertices: Vertices, triangles: Triangles, degrees: float) -> _View:
    width, height = (round(PX_PER_M * room) for room in ROOM_M)
    camera = Camera(
        focal_length_px=PX_PER_M * DISTANCE_M,
        centre_x=0.5 * width,
        centre_y=height - 0.05 * PX_PER_M,
        width=width,
        height=height,
    )
    rendering = render(_seen(vertices, degrees), triangles, camera)
    lit = np.clip(rendering.vertex_normals @ TO_LIGHT, 0.0, 1.0)
    grey = shade_image(rendering, FILL_LIGHT + (1.0 - FILL_LIGHT) * lit)[..., None]
    blank = 1.0 - rendering.silhouette[..., None].astype(np.float32)
    picture = to_levels(display_from_linear(grey * CLAY + blank))
    return _View(degrees=degrees, rendering=rendering, picture=picture)


def _seen(points: Points3D, degrees: float) -> Points3D:
    turned = turned_about_vertical(points * CAMERA_AXES, np.zeros(3), degrees)
    return turned + [0.0, 0.0, DISTANCE_M]


def _dense(line: Points3D) -> Float[np.ndarray, "dense 3"]:
    """Points every few millimetres along a line."""
    pieces = [
        np.linspace(start, end, max(2, int(np.linalg.norm(end - start) / STEP_M)))
        for start, end in pairwise(line)
    ]
    return np.concatenate(pieces)


def _visible(view: _View, tape: _Tape) -> Bool[np.ndarray, " k"]:
    pixels, depth = view.project(tape.points)
    if tape.inside:
        return np.ones(len(pixels), dtype=np.bool_)
    columns, rows = np.floor(pixels).astype(int).T
    return depth < view.rendering.depth[rows, columns] + HIDDEN_M


def _shown_length(view: _View, tape: _Tape) -> float:
    """Length of what is visible, as it appears: foreshortened tapes tell less."""
    pixels, _ = view.project(tape.points)
    steps = np.linalg.norm(np.diff(pixels, axis=0), axis=1)
    return float(steps[_visible(view, tape)[1:]].sum())


def _cell(tape: _Tape, views: Sequence[_View]) -> Levels:
    view = views[0]
    for other in views[1:]:
        if _shown_length(other, tape) > PREFERENCE * _shown_length(view, tape):
            view = other
    pixels, _ = view.project(tape.points)
    visible = _visible(view, tape)
    width, height = CELL_PX[0], CELL_PX[1] - LABEL_PX
    centre = 0.5 * (pixels.min(axis=0) + pixels.max(axis=0))
    span = np.ptp(pixels, axis=0)
    tall = MARGIN * max(span[1], span[0] * height / width, LEAST_M * PX_PER_M / MARGIN)
    scale = height / tall
    shift = np.array([0.5 * width, 0.5 * height]) - scale * centre
    matrix = np.array([[scale, 0.0, shift[0]], [0.0, scale, shift[1]]])
    blurred = cv2.GaussianBlur(view.picture, (0, 0), max(0.3, 0.45 / scale))
    cell = cv2.warpAffine(
        blurred, matrix, (width, height), flags=cv2.INTER_LINEAR, borderValue=(255, 255, 255)
    )
    drawn = scale * pixels + shift
    for seen, colour, thickness in ((False, HIDDEN_TAPE, 1), (True, TAPE, 2)):
        for start, end, at in zip(drawn[:-1], drawn[1:], visible[1:], strict=True):
            if at == seen:
                _draw(cell, start, end, colour=colour, thickness=thickness)
    label = np.full((LABEL_PX, width, 3), 255, dtype=np.uint8)
    cv2.putText(
        label, tape.name, (3, LABEL_PX - 5), cv2.FONT_HERSHEY_SIMPLEX, 0.42, INK, 1, cv2.LINE_AA
    )
    return np.concatenate([label, cell])


def _draw(
    cell: Levels,
    start: Float[np.ndarray, "2"],
    end: Float[np.ndarray, "2"],
    *,
    colour: tuple[int, int, int],
    thickness: int,
) -> None:
    """A line with ends between pixels: OpenCV counts in sixteenths."""
    (x0, y0), (x1, y1) = np.rint(16.0 * np.stack([start, end])).astype(int).tolist()
    cv2.line(cell, (x0, y0), (x1, y1), colour, thickness, cv2.LINE_AA, 4)


def _sheet(cells: Sequence[Levels]) -> UInt8[np.ndarray, "sheet_h sheet_w 3"]:
    blank = np.full_like(cells[0], 255)
    padded = [*cells, *[blank] * (-len(cells) % COLUMNS)]
    rows = [
        np.concatenate(padded[start : start + COLUMNS], axis=1)
        for start in range(0, len(padded), COLUMNS)
    ]
    return np.concatenate(rows)


if __name__ == "__main__":
    main()
