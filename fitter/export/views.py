"""The body as plain clay from several sides, for people looking at results.

A silhouette can be right and the body wrong (the paper's Fig. 5): the side view shows it.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from scipy import sparse

from fitter.arrays import Normals, Triangles, Vector3, Vertices
from fitter.body.scape import CAMERA_AXES
from fitter.export.antialiasing import SAMPLES, render_finely, vertex_pictures
from fitter.export.display import finer, slope_bounds
from fitter.export.gltf_mesh import BodyTexture
from fitter.numerics.rotations import unit_vectors
from fitter.parameters import CameraTilt
from fitter.person.upright import upright_rotation
from fitter.render.camera import Camera
from fitter.render.rasterizer import Rendering, render, shade_image

PANEL_HEIGHT_PX = 720
PANEL_WIDTH_PX = 520
MARGIN_SHARE = 0.06

CANONICAL_DISTANCE_M = 6.0
"""From where the canonical body is seen: far enough that near parts do not swell."""

TO_LIGHT = np.array([-0.45, -0.60, -0.66])
"""Unit direction toward the light, camera frame: over the onlooker's left shoulder."""

CLAY = np.array([0.62, 0.53, 0.47])
"""Linear albedo."""

FILL_LIGHT = 0.18

CALM, CALM_FINE, FINE_M = 3, 80, 0.012
"""Passes that calm all normals, and those at edges shorter than the last."""

LABEL_COLOUR = (70, 70, 70)

EYE_LEVEL_M = 0.9
"""Height of the onlooker's eye above the ground: about the middle of a standing body."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyView:
    """A body as it is to be seen.

    Attributes
    ----------
    label
        Written above it.
    vertices
        (m, 3) body frame, metres; it stands on its lowest vertex.
    degrees
        How far the onlooker has walked to the right round it, from its front.
    """

    label: str
    vertices: Vertices
    degrees: float = 0.0


ShownColours = BodyTexture | Float[np.ndarray, "m 3"]
"""A texture, or linear colours of the vertices."""


def preview(
    views: Sequence[BodyView], triangles: Triangles, colours: ShownColours | None = None
) -> UInt8[np.ndarray, "h w 3"]:
    """Panels from left to right, in one scale and on one ground, as :func:`shown_body` shows."""
    seen = [_on_the_ground(view) for view in views]
    camera = _panel_camera(np.concatenate(seen))
    panels = [
        _labelled(shown_body(vertices, triangles, camera, colours), view.label)
        for view, vertices in zip(views, seen, strict=True)
    ]
    return np.concatenate(panels, axis=1)


def _on_the_ground(view: BodyView) -> Vertices:
    low, high = view.vertices.min(axis=0), view.vertices.max(axis=0)
    x, _, z = 0.5 * (low + high)
    eye_level = np.array([x, low[1] + EYE_LEVEL_M, z])
    return before_onlooker(view.vertices, eye_level, view.degrees)


def views_picture(
    posed_vertices: Vertices, root: Vector3, tilt: CameraTilt | None, triangles: Triangles
) -> UInt8[np.ndarray, "h w 3"]:
    """Two panels: the posed body from the camera and from the side.

    Parameters
    ----------
    posed_vertices
        (m, 3) camera frame, metres; seen in the fit's own perspective.
    root
        Position of the root joint in the camera frame: the side view turns about its vertical.
    tilt
        Of the camera: what is vertical. None where it is not known, and the camera taken as level.
    """
    panels = {
        "from the camera": posed_vertices,
        "from the right of the picture": turned_about_vertical(
            under_level_camera(posed_vertices, root, tilt), root, 90.0
        ),
    }
    return np.concatenate(
        [
            _labelled(coloured_body(vertices, triangles, _panel_camera(vertices)), label)
            for label, vertices in panels.items()
        ],
        axis=1,
    )


def middle_of(vertices: Vertices) -> Vector3:
    """Middle of the box around a body."""
    return 0.5 * (vertices.max(axis=0) + vertices.min(axis=0))


def before_onlooker(vertices: Vertices, centre: Vector3, degrees: float) -> Vertices:
    """Body-frame vertices in the camera frame of somebody who walked to the right round a point.

    They are :data:`CANONICAL_DISTANCE_M` away from that point and look at it.
    """
    there = np.array([0.0, 0.0, CANONICAL_DISTANCE_M])
    return turned_about_vertical((vertices - centre) * CAMERA_AXES + there, there, degrees)


def under_level_camera(vertices: Vertices, root: Vector3, tilt: CameraTilt | None) -> Vertices:
    """Camera-frame vertices as a level camera would see them, turned about the root joint."""
    if tilt is None:
        return vertices
    return (vertices - root) @ upright_rotation(tilt).T * CAMERA_AXES + root


def turned_about_vertical(vertices: Vertices, centre: Vector3, degrees: float) -> Vertices:
    """Camera-frame vertices as an onlooker sees them who walked to the right round ``centre``.

    Positive degrees bring what was at the right of the picture to the front.
    """
    angle = np.radians(degrees)
    rotation = np.array(
        [
            [np.cos(angle), 0.0, np.sin(angle)],
            [0.0, 1.0, 0.0],
            [-np.sin(angle), 0.0, np.cos(angle)],
        ]
    )
    return (vertices - centre) @ rotation.T + centre


def framing_camera(vertices: Vertices, *, width: int, height: int) -> Camera:
    """A camera at the origin whose picture the vertices fill but for a margin.

    Changing only focal length and principal point crops and magnifies; the perspective stays.
    """
    low, high = slope_bounds(vertices)
    inner = (1.0 - 2.0 * MARGIN_SHARE) * np.array([width, height])
    focal = float((inner / (high - low)).min())
    centre = 0.5 * np.array([width, height]) - focal * 0.5 * (low + high)
    return Camera(
        focal_length_px=focal,
        centre_x=float(centre[0]),
        centre_y=float(centre[1]),
        width=width,
        height=height,
    )


def _panel_camera(vertices: Vertices) -> Camera:
    return framing_camera(vertices, width=PANEL_WIDTH_PX, height=PANEL_HEIGHT_PX)


def _labelled(levels: UInt8[np.ndarray, "h w 3"], label: str) -> UInt8[np.ndarray, "h w 3"]:
    """The panel with words in its upper left corner."""
    font = cv2.FONT_HERSHEY_SIMPLEX
    return cv2.putText(levels, label, (12, 24), font, 0.55, LABEL_COLOUR, 1, cv2.LINE_AA)


def coloured_body(
    vertices: Vertices,
    triangles: Triangles,
    camera: Camera,
    colour: Float[np.ndarray, "3"] = CLAY,
) -> UInt8[np.ndarray, "h w 3"]:
    """A lit body before white paper; vertices in the camera's frame, metres, linear albedo."""
    fine = render_finely(vertices, triangles, camera)
    lit = np.clip(_calm_normals(fine.rendering) @ TO_LIGHT, 0.0, 1.0)
    shading = FILL_LIGHT + (1.0 - FILL_LIGHT) * lit
    (levels,) = vertex_pictures([shading[:, None] * colour], fine)
    return levels


def _calm_normals(rendering: Rendering) -> Normals:
    """Normals as of a tailor's dummy: without a face, nipples or genitals.

    Each is the mean of its neighbours', again and again where the mesh is fine.
    """
    vertices, normals = rendering.vertices, rendering.vertex_normals
    first, second = rendering.triangles.ravel(), np.roll(rendering.triangles, -1, axis=1).ravel()
    shares = 1.0 / np.bincount(first, minlength=len(vertices))[first]
    around = sparse.csr_array((shares, (first, second)), shape=(len(vertices), len(vertices)))
    lengths = shares * np.linalg.norm(vertices[first] - vertices[second], axis=1)
    fine = np.flatnonzero(np.bincount(first, lengths, len(vertices)) < FINE_M)
    for _ in range(CALM):
        normals = around @ normals
    among = around[fine]
    for _ in range(CALM_FINE):
        normals[fine] = among @ normals
    return unit_vectors(normals)


def shown_body(
    vertices: Vertices, triangles: Triangles, camera: Camera, colours: ShownColours | None
) -> UInt8[np.ndarray, "h w 3"]:
    """A body before white paper in colours as they are; without any, of clay."""
    if colours is None:
        return coloured_body(vertices, triangles, camera)
    if isinstance(colours, np.ndarray):
        (picture,) = vertex_pictures([colours], render_finely(vertices, triangles, camera))
        return picture
    rendering = render(vertices[colours.owners], colours.triangles, finer(camera, SAMPLES))
    picture = cv2.imdecode(np.frombuffer(colours.picture, np.uint8), cv2.IMREAD_COLOR_RGB)
    assert picture is not None
    columns, rows = (shade_image(rendering, each) for each in colours.texels.T * len(picture) - 0.5)
    levels = np.asarray(cv2.remap(picture, columns, rows, cv2.INTER_LINEAR), dtype=np.uint8)
    levels[~rendering.silhouette] = 255
    return cv2.resize(levels, (camera.width, camera.height), interpolation=cv2.INTER_AREA)
