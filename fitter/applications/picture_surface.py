"""Colours of a fitted body's surface as a picture shows them, with their credibility.

Hair has the colours of the scalp and hangs together with it in the picture. Cloth of the same
colour may touch it; but hair does not cover most of a person.
"""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np
from jaxtyping import Bool, Float, Integer, UInt8
from scipy import sparse

from fitter.arrays import GreyImage, Image, Mask, Points2D, Triangles, Vector3, Vertices
from fitter.numerics.rotations import unit_vectors
from fitter.observation.maps import sample
from fitter.observation.pixels import display_from_linear, linear_from_display
from fitter.render.camera import Camera
from fitter.render.rasterizer import DEPTH_TOLERANCE_M, Rendering, render

GRAZING, SQUARE = 0.2, 0.6
"""Cosines between normal and view: below the first a surface is not read from a picture, from the
second on it is believed wholly. In between a pixel spans more and more of the surface."""

CONTOUR_M = 0.008
"""A fitted contour lies so far off the person's: nearer to one, a pixel may show what is behind."""

LIMB_M = 0.02
"""A limb before the trunk may lie so far off its own place: beside it, the trunk may show it."""

DEPTH_JUMP_M = 0.04
"""A jump of depth within that distance to either side is a contour, on the outline or before the
body itself. A surface that sinks so far there is turned away by 68 degrees, and hardly believed."""

HIDDEN_M = 0.015
"""So far behind what a pixel shows a point is hidden; up to the depth's tolerance it is seen."""

LEAST_PX = 2
"""Lower bound of all these distances: over so many pixels a camera's picture is itself blurred."""

Colours = Float[np.ndarray, "k 3"]
Beliefs = Float[np.ndarray, " k"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SurfacePoints:
    """k points on triangles of the body.

    Attributes
    ----------
    corners
        (k, 3) vertex ids.
    weights
        (k, 3) barycentric coordinates.
    """

    corners: Integer[np.ndarray, "k 3"]
    weights: Float[np.ndarray, "k 3"]

    def of(self, values: Float[np.ndarray, "m ..."]) -> Float[np.ndarray, "k ..."]:
        """Values of vertices, interpolated: a sparse product, as fast as memory is read."""
        starts = np.arange(0, self.corners.size + 1, 3)
        matrix = sparse.csr_array(
            (self.weights.ravel(), self.corners.ravel(), starts),
            shape=(len(self.corners), len(values)),
        )
        return matrix @ values

    def moved(self, to: Integer[np.ndarray, " m"]) -> "SurfacePoints":
        """The points between the vertices that each corner is moved to."""
        return SurfacePoints(corners=to[self.corners], weights=self.weights)

    def near(self, vertices: Bool[np.ndarray, " m"]) -> Integer[np.ndarray, " n"]:
        """Which points any of these vertices has a share in."""
        return np.flatnonzero(self.of(vertices.astype(np.float64)) > 0.0)

    def some(self, chosen: slice | Integer[np.ndarray, " n"]) -> "SurfacePoints":
        """Some of them."""
        return SurfacePoints(corners=self.corners[chosen], weights=self.weights[chosen])


@dataclass(frozen=True, eq=False, kw_only=True)
class PictureSurface:
    """A posed body before its picture.

    Attributes
    ----------
    rendering
        The body, camera frame, at the picture's size.
    linear_rgb
        (h, w, 3) the picture in linear light.
    clear
        (h, w) 1 where a pixel shows the body's own surface, off every contour.
    crown
        Linear colour about the crown, :func:`crown_colour`; None where that is not in the picture.
    """

    rendering: Rendering
    linear_rgb: Image
    clear: GreyImage
    crown: Vector3 | None

    @classmethod
    def of(
        cls,
        vertices: Vertices,
        triangles: Triangles,
        camera: Camera,
        linear_rgb: Image,
        mask: Mask | None,
        *,
        scalp: Bool[np.ndarray, " f"],
        face: Bool[np.ndarray, " f"],
    ) -> "PictureSurface":
        """Put a body before its picture.

        Parameters
        ----------
        vertices
            (m, 3) camera frame, metres.
        camera
            Of this picture, whose size it has.
        mask
            (h, w) the person, where that is known better than by the body's own outline.
        scalp, face
            Which triangles hair grows on, from where it may hang over others, and which are the
            rest of head and neck.
        """
        rendering = render(vertices, triangles, camera)
        shown = rendering.silhouette if mask is None else rendering.silhouette & mask
        person = shown if mask is None else mask
        hair = loose_hair(rendering, linear_rgb, person, scalp=scalp, face=face)
        return cls(
            rendering=rendering,
            linear_rgb=linear_rgb,
            clear=_off_contours(rendering, shown) * _off(hair, _width_px(rendering, CONTOUR_M)),
            crown=crown_colour(rendering, linear_rgb, person, scalp=scalp),
        )

    @cached_property
    def _channels(self) -> tuple[GreyImage, ...]:
        return tuple(np.ascontiguousarray(self.linear_rgb[..., k]) for k in range(3))

    def colours(self, points: SurfacePoints) -> Float[np.ndarray, "k 3"]:
        """Linear red, green and blue where the points are in the picture, seen or not."""
        pixels = self._pixels(points)
        return np.stack([sample(channel, pixels)[0] for channel in self._channels], axis=1)

    def belief(self, points: SurfacePoints) -> Float[np.ndarray, " k"]:
        """Visibility of points in the picture: 0 for hidden, 1 for seen squarely."""
        positions = points.of(self.rendering.vertices)
        normals = unit_vectors(points.of(self.rendering.vertex_normals))
        pixels = self._pixels(points)
        height, width = self.clear.shape
        x, y = pixels.T
        inside = (x >= 0.0) & (x < width) & (y >= 0.0) & (y < height)
        columns, rows = (np.where(inside, each, 0.0).astype(np.intp) for each in (x, y))
        depth = self.rendering.depth[rows, columns]
        far = positions[:, 2]
        before = 1.0 - smooth_step(far - depth, DEPTH_TOLERANCE_M, HIDDEN_M)
        seen = inside & (far > 0.0)
        cosines = -np.einsum("kd,kd->k", normals, unit_vectors(positions))
        squarely = smooth_step(cosines, GRAZING, SQUARE)
        return np.where(seen, squarely * before, 0.0) * sample(self.clear, pixels)[0]

    def look(self, points: SurfacePoints) -> tuple[Colours, Beliefs]:
        """Colours and beliefs of points."""
        return self.colours(points), self.belief(points)

    def _pixels(self, points: SurfacePoints) -> Points2D:
        return self.rendering.camera.project(points.of(self.rendering.vertices))


def smooth_step(
    values: Float[np.ndarray, "*n"], low: float, high: float
) -> Float[np.ndarray, "*n"]:
    """0 up to ``low``, 1 from ``high`` on, and without a corner from one to the other."""
    share = np.clip((values - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def _off_contours(rendering: Rendering, shown: Mask) -> GreyImage:
    """1 for what is shown off every contour.

    Blurred by the same width, so that what is believed fades out before a contour.
    """
    depth = rendering.depth.astype(np.float32)
    if not shown.any():
        return np.zeros(depth.shape, dtype=np.float32)
    far = np.float32(depth[shown].max() + 1.0)
    depth = np.where(shown, depth, far)
    near = cv2.erode(depth, _window(_width_px(rendering, CONTOUR_M)))
    jump = cv2.dilate(depth, _window(_width_px(rendering, CONTOUR_M))) - near
    before = depth - cv2.erode(depth, _window(_width_px(rendering, LIMB_M)))
    blurred = shown & (jump < DEPTH_JUMP_M) & (before < DEPTH_JUMP_M)
    return _off(~blurred, _width_px(rendering, CONTOUR_M))


def _off(hidden: Mask, width: int) -> GreyImage:
    """0 for what is hidden, and fading toward it."""
    clear = (~hidden).astype(np.float32)
    return cv2.GaussianBlur(clear, (width, width), 0.0) * clear


def _window(width: int) -> UInt8[np.ndarray, "w w"]:
    return np.ones((width, width), dtype=np.uint8)


def _width_px(rendering: Rendering, radius_m: float) -> int:
    """The odd width of a window of a radius on the body."""
    depth = rendering.depth[rendering.silhouette]
    metre_px = rendering.camera.focal_length_px / float(np.median(depth)) if len(depth) else 0.0
    return 2 * max(round(radius_m * metre_px), LEAST_PX) + 1


HAIR_M = 0.03
"""Height of hair and hats above a body's scalp, and width of what is read on it beside them."""


def crown_colour(
    rendering: Rendering, linear_rgb: Image, person: Mask, *, scalp: Bool[np.ndarray, " f"]
) -> Vector3 | None:
    """The linear colour of most of what is seen about the scalp's outline, or else of the scalp.

    Foreheads reach up a scalp that is seen from the front; about its outline there is hair, or a
    hat, or none. The outline of the person shows what is behind, too.
    """
    on_scalp = rendering.silhouette & scalp[rendering.face_ids]
    within = cv2.erode(person.astype(np.uint8), _window(2 * LEAST_PX + 1)) > 0
    near = cv2.dilate(on_scalp.astype(np.uint8), _window(_width_px(rendering, HAIR_M))) > 0
    inner = cv2.erode(
        rendering.silhouette.astype(np.uint8), _window(_width_px(rendering, CONTOUR_M))
    )
    about = near & within & (on_scalp | ~rendering.silhouette) & (inner == 0)
    for seen in (about, on_scalp & within):
        if np.count_nonzero(seen) >= LEAST_SEEN:
            colours, label = linear_rgb[seen], nearest_of_two(_lab(linear_rgb)[seen])
            return np.median(colours[label == np.bincount(label).argmax()], axis=0)
    return None


LEAST_SEEN = 40
"""Pixels of the scalp from which a colour of hair is learnt."""

COLOURS = 2
"""Colours of a scalp: hair and its light, hair and a band."""

LEAST_SHARE = 0.25
"""Least share of the seen scalp from which a colour of it counts as hair's."""

ALIKE = 2.5
"""Deviations up to which a pixel has the colour of hair."""

MOST_OF_BODY = 0.12
"""Share of the person below the head that hair may cover; more is cloth of its colour, as
a shirt seen from the front, which is a fifth of it."""

CHROMA, DARKEST_SHADE = 0.35, 0.06
"""Hair whose channels are in the same ratio to the face's within the first (of logarithms), and
brighter than this share of it, cannot be told from skin in the shade: it is left where it is."""

DARKEST = 0.004
"""Least linear light that is told apart; below it noise dominates."""

_DEVIATIONS = np.array([[8.0, 3.0, 3.0], [16.0, 6.0, 6.0]])
# Least and most of L, a, b (8 bits): light on hair changes its brightness most.


def loose_hair(
    rendering: Rendering,
    linear_rgb: Image,
    person: Mask,
    *,
    scalp: Bool[np.ndarray, " f"],
    face: Bool[np.ndarray, " f"],
) -> Mask:
    """Places where hair hides the body below the head.

    Parameters
    ----------
    rendering
        The body at the picture's size.
    linear_rgb
        (h, w, 3) the picture in linear light.
    person
        (h, w) the pixels that show the person.
    scalp, face
        Which triangles hair grows on, and which are the rest of head and neck.
    """
    hidden = np.zeros(person.shape, dtype=bool)
    seen = rendering.silhouette & person
    on_scalp, on_face = (seen & own[rendering.face_ids] for own in (scalp, face))
    if np.count_nonzero(on_scalp) < LEAST_SEEN:
        return hidden
    lab = _lab(linear_rgb)
    below = seen & ~on_scalp & ~on_face
    for mean, deviation in _colours_of(lab[on_scalp]):
        if _may_be_skin(_linear(mean), linear_rgb[on_face]):
            continue
        alike = person & ((np.abs(lab - mean) / deviation).max(axis=2) < ALIKE)
        hanging = _connected(alike | on_scalp, on_scalp) & alike & below
        if np.count_nonzero(hanging) < MOST_OF_BODY * np.count_nonzero(below):
            hidden |= hanging
    return hidden


def _lab(linear_rgb: Image) -> Float[np.ndarray, "h w 3"]:
    levels = np.rint(255.0 * display_from_linear(np.clip(linear_rgb, 0.0, 1.0))).astype(np.uint8)
    return cv2.cvtColor(levels, cv2.COLOR_RGB2LAB).astype(np.float64)


def _linear(lab: Vector3) -> Vector3:
    levels = cv2.cvtColor(np.rint(lab).astype(np.uint8)[None, None], cv2.COLOR_LAB2RGB)
    return linear_from_display(levels[0, 0] / 255.0)


def _colours_of(
    seen: Float[np.ndarray, "k 3"],
) -> list[tuple[Vector3, Vector3]]:
    """Means and deviations of the colours of a scalp that cover enough of it."""
    label = nearest_of_two(seen)
    found: list[tuple[Vector3, Vector3]] = []
    for each in range(COLOURS):
        own = seen[label == each]
        if len(own) >= LEAST_SHARE * len(seen):
            deviation = 1.4826 * np.median(np.abs(own - np.median(own, axis=0)), axis=0)
            found.append((np.median(own, axis=0), np.clip(deviation, *_DEVIATIONS)))
    return found


def _may_be_skin(hair: Vector3, face: Float[np.ndarray, "k 3"]) -> bool:
    """Whether a linear colour may also be the face's in the shade, which leaves chroma as it is."""
    if len(face) < LEAST_SEEN:
        return False
    skin = np.maximum(np.median(face, axis=0), DARKEST)
    hair = np.maximum(hair, DARKEST)
    alike = np.ptp(np.log(hair / skin)) < CHROMA
    return bool(alike) and float(hair.sum()) > DARKEST_SHADE * float(skin.sum())


def nearest_of_two(seen: Float[np.ndarray, "k 3"]) -> Integer[np.ndarray, " k"]:
    """k-means from the two ends of the axis along which the colours differ most."""
    away = seen - seen.mean(axis=0)
    ends = away @ np.linalg.svd(away, full_matrices=False)[2][0] > 0.0
    _, labels, _ = cv2.kmeans(
        seen.astype(np.float32),
        COLOURS,
        ends.astype(np.int32),
        (cv2.TERM_CRITERIA_MAX_ITER, 10, 0.0),
        1,
        cv2.KMEANS_USE_INITIAL_LABELS,
    )
    return np.asarray(labels, dtype=np.intp).ravel()


def _connected(region: Mask, seeds: Mask) -> Mask:
    """The connected components of a region that hold a seed."""
    _, labels = cv2.connectedComponents(region.astype(np.uint8))
    holding = np.unique(labels[seeds & region])
    return np.isin(labels, holding[holding > 0])
