"""Pictures of a box before a wall, with pixels that its borders mix as a lens would."""

import numpy as np

from fitter.numerics.meshes import mesh_topology
from fitter.render.camera import Camera
from fitter.render.contours import ModelEdges, model_edges
from fitter.render.rasterizer import Rendering, render

WIDTH, HEIGHT = 320, 240
CAMERA = Camera(focal_length_px=900.0, centre_x=160.0, centre_y=120.0, width=WIDTH, height=HEIGHT)
DEPTH_M = 3.0
PIXELS_PER_METRE = CAMERA.focal_length_px / DEPTH_M

SKIN, WALL = np.array([0.7, 0.5, 0.4]), np.array([0.35, 0.4, 0.45])


def boxes(*spans: tuple[float, float]) -> tuple[Rendering, ModelEdges]:
    """Upright boxes 160 px high, each between two columns, finely divided along their height."""
    rows = np.linspace(40.0, 200.0, 41)
    vertices, triangles = [], []
    for left, right in spans:
        # Tapering backward, so that the front face alone is seen and its rim is the contour.
        base = 4 * len(rows) * len(vertices)
        rings = [[(left, 0.0), (left + 1.0, 0.1), (right - 1.0, 0.1), (right, 0.0)] for _ in rows]
        points = [
            [(x - 160.0) / 900.0 * DEPTH_M, (row - 120.0) / 900.0 * DEPTH_M, DEPTH_M + deep]
            for row, ring in zip(rows, rings, strict=True)
            for x, deep in ring
        ]
        vertices.append(np.array(points))
        for k in range(len(rows) - 1):
            for side in range(4):
                a, b = base + 4 * k + side, base + 4 * k + (side + 1) % 4
                triangles += [[a, b, b + 4], [a, b + 4, a + 4]]
        top, bottom = base, base + 4 * (len(rows) - 1)
        triangles += [[top, top + 3, top + 2], [top, top + 2, top + 1]]
        triangles += [[bottom, bottom + 1, bottom + 2], [bottom, bottom + 2, bottom + 3]]
    mesh = np.array(triangles, dtype=np.int32)
    points = np.concatenate(vertices)
    rendering = render(points, mesh, CAMERA)
    return rendering, model_edges(rendering, mesh_topology(mesh, vertex_count=len(points)))


def coverage(left: float, right: float) -> np.ndarray:
    """(h, w) share of each pixel between two columns and within the rows of the boxes."""
    x, y = np.arange(WIDTH), np.arange(HEIGHT)
    across = np.clip(right - x, 0, 1) - np.clip(left - x, 0, 1)
    down = np.clip(200.0 - y, 0, 1) - np.clip(40.0 - y, 0, 1)
    return down[:, None] * across


def picture(person: np.ndarray, wall: np.ndarray, share: np.ndarray) -> np.ndarray:
    """(h, w, 3) the person over the wall; colours of one or of all pixels."""
    return share[..., None] * person + (1.0 - share[..., None]) * wall
