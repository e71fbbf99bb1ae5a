"""Pictures of dressed people with a label for each pixel: layers drawn, lit, and photographed."""

from typing import Final, NamedTuple

import cv2
import numpy as np
from jaxtyping import Float, UInt8
from scipy.ndimage import gaussian_filter

from fitter.arrays import Vertices
from fitter.render.camera import Camera
from fitter.render.rasterizer import Rendering, render
from fitter.training.dressed.bodies import StandingBody, turn
from fitter.training.dressed.people import dressed_person
from fitter.training.dressed.surfaces import Layer, Places, noise
from fitter.training.dressed.surroundings import surroundings, with_shadow

SIZE: Final = 256
"""Side of a picture: that of the landmark network's crop."""

DRAWN_SIZE: Final = 400
"""Side at which people are drawn, before they are averaged down."""

RANK_M: Final = 0.012
"""A layer may lie so much deeper than one of a rank below, and still be seen."""

FOLD_M: Final = 0.012
CROP_SHARE: Final = (0.46, 0.58)
"""Half a crop's side over 1.25 statures."""

FACES, BEHIND = (0.5, 12.0), (0.26, 14.0)
"""Shares and spreads (degrees) of people seen from the front and from behind."""

OCCLUSION: Final = ((2.5, 9.0), (7.0, 5.0))
"""Pixels around, and nats a metre by which what lies deeper than they do is darker."""


class DressedPicture(NamedTuple):
    """A crop in sRGB and its labels (:class:`fitter.detection.worn_parts.WornPart`)."""

    picture: UInt8[np.ndarray, "s s 3"]
    labels: UInt8[np.ndarray, "s s"]


class Drawn(NamedTuple):
    """What is seen through each pixel: labels, albedo, normal, height of folds, depth, gloss."""

    labels: UInt8[np.ndarray, "h w"]
    albedo: Float[np.ndarray, "h w 3"]
    normals: Float[np.ndarray, "h w 3"]
    folds: Float[np.ndarray, "h w"]
    depth: Float[np.ndarray, "h w"]
    gloss: Float[np.ndarray, "h w"]


def dressed_picture(seed: int) -> DressedPicture:
    """The picture of a number: a random person before something, as a camera shows them."""
    rng = np.random.default_rng(seed)
    body, layers = dressed_person(rng)
    camera, turned, away = _view(body, rng)
    drawn = draw(layers, camera, turned, away, rng)
    rows, columns = np.nonzero(drawn.labels)
    light = _lit(drawn, camera.focal_length_px / away[2], rows, columns, rng)
    person = np.zeros((DRAWN_SIZE, DRAWN_SIZE, 4), np.float32)
    person[rows, columns, :3], person[rows, columns, 3] = light, 1.0
    person = cv2.resize(person, (SIZE, SIZE), interpolation=cv2.INTER_AREA)
    labels = cv2.resize(drawn.labels, (SIZE, SIZE), interpolation=cv2.INTER_NEAREST)
    gain = min(rng.uniform(0.6, 1.25) / max(float(np.percentile(light, 90)), 0.25), 3.0)
    behind = with_shadow(surroundings(rng, SIZE), labels > 0, rng)
    seen = gain * person[..., :3] + (1.0 - person[..., 3:]) * behind
    return DressedPicture(photographed(seen * np.exp(rng.normal(0.0, 0.07, 3)), rng), labels)


def _view(
    body: StandingBody, rng: np.random.Generator
) -> tuple[Camera, Float[np.ndarray, "3 3"], Float[np.ndarray, "3"]]:
    """A camera, and how the body stands before it: turned by a matrix, then moved."""
    kind = rng.random()
    if kind < FACES[0]:
        yaw = rng.normal(0.0, FACES[1])
    elif kind < FACES[0] + BEHIND[0]:
        yaw = 180.0 + rng.normal(0.0, BEHIND[1])
    else:
        yaw = rng.uniform(0.0, 360.0)
    upright = turn("z", rng.normal(0.0, 2.5)) @ turn("x", rng.normal(3.0, 6.0)) @ turn("y", yaw)
    distance = rng.uniform(2.2, 6.0)
    half_m = 1.25 * body.stature_m * rng.uniform(*CROP_SHARE)
    camera = Camera(
        focal_length_px=DRAWN_SIZE * distance / (2.0 * half_m),
        centre_x=0.5 * DRAWN_SIZE,
        centre_y=0.5 * DRAWN_SIZE,
        width=DRAWN_SIZE,
        height=DRAWN_SIZE,
    )
    aside = body.stature_m * rng.normal(0.0, 0.05, 2)
    return camera, np.diag([1.0, -1.0, -1.0]) @ upright, np.array([*aside, distance])


def draw(
    layers: list[Layer],
    camera: Camera,
    turned: Float[np.ndarray, "3 3"],
    away: Float[np.ndarray, "3"],
    rng: np.random.Generator,
) -> Drawn:
    """What is seen of layers that are turned by a matrix, then moved, before a camera."""
    shape = camera.height, camera.width
    drawn = Drawn(
        labels=np.zeros(shape, np.uint8),
        albedo=np.zeros((*shape, 3)),
        normals=np.zeros((*shape, 3)),
        folds=np.zeros(shape),
        depth=np.full(shape, np.inf),
        gloss=np.zeros(shape),
    )
    nearest = np.full(shape, np.inf)
    for layer in layers:
        seen = render(layer.vertices @ turned.T + away, layer.triangles, camera)
        rows, columns, values = _fragments(
            seen, np.concatenate([layer.places, seen.vertex_normals], axis=1)
        )
        depth = seen.depth[rows, columns]
        order = depth - RANK_M * layer.rank
        kept = order < nearest[rows, columns]
        if layer.keeps is not None:
            kept &= layer.keeps(Places(*values[:, :5].T))
        if not kept.any():
            continue
        pixels = rows[kept], columns[kept]
        places = Places(*values[kept, :5].T)
        nearest[pixels], drawn.depth[pixels] = order[kept], depth[kept]
        drawn.labels[pixels], drawn.gloss[pixels] = layer.part, layer.gloss
        drawn.albedo[pixels] = np.clip(layer.paint(places), 0.002, 0.95)
        drawn.normals[pixels] = values[kept, 5:]
        drawn.folds[pixels] = fold_heights(layer, places.points, rng)
    return drawn


def fold_heights(layer: Layer, points: Vertices, rng: np.random.Generator) -> np.ndarray | float:
    """Height of the folds, metres: mostly long downward, some sharp."""
    if layer.folds == 0.0:
        return 0.0
    along = np.array([1.0, 0.35 if rng.random() < 0.6 else 1.6, 1.0])
    height = noise(rng, points * along, 0.07 * layer.fold_size, octaves=3)
    height = np.abs(height) if rng.random() < 0.4 else height
    return FOLD_M * layer.folds * layer.fold_size * height


def _fragments(
    seen: Rendering, values: Float[np.ndarray, "m a"]
) -> tuple[np.ndarray, np.ndarray, Float[np.ndarray, "k a"]]:
    """Rows and columns of covered pixels, and the vertices' values there, linear in the picture."""
    rows, columns = np.nonzero(seen.face_ids >= 0)
    corners = seen.triangles[seen.face_ids[rows, columns]]
    first, second, third = (seen.projected[corners[:, k]] for k in range(3))
    at = np.stack([columns + 0.5, rows + 0.5], axis=1) - third
    u, v = first - third, second - third
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    one = (at[:, 0] * v[:, 1] - at[:, 1] * v[:, 0]) / area
    two = (u[:, 0] * at[:, 1] - u[:, 1] * at[:, 0]) / area
    shares = np.clip(np.stack([one, two, 1.0 - one - two], axis=1), -0.2, 1.2)
    return rows, columns, np.einsum("kc,kca->ka", shares, values[corners])


def _lit(
    drawn: Drawn,
    pixels_per_metre: float,
    rows: np.ndarray,
    columns: np.ndarray,
    rng: np.random.Generator,
) -> Float[np.ndarray, "k 3"]:
    """Linear light of the covered pixels under a sky and up to three lamps."""
    slopes = np.asarray(np.gradient(gaussian_filter(drawn.folds, 1.0) * pixels_per_metre))
    normals, albedo = drawn.normals[rows, columns], drawn.albedo[rows, columns]
    normals[:, :2] += slopes[::-1, rows, columns].T
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    gloss = drawn.gloss[rows, columns]
    sky = rng.uniform(0.25, 1.0) * np.exp(rng.normal(0.0, 0.06, 3))
    light = sky * (1.0 - rng.uniform(-0.1, 0.5) * normals[:, 1:2])
    for _ in range(rng.integers(1, 4)):
        to_lamp = rng.normal(size=3)
        to_lamp[2] = -abs(to_lamp[2]) - 0.1 if rng.random() < 0.85 else abs(to_lamp[2])
        to_lamp[1] = -abs(to_lamp[1]) if rng.random() < 0.8 else to_lamp[1]
        to_lamp /= np.linalg.norm(to_lamp)
        strength, soft = rng.uniform(0.1, 1.1), rng.uniform(0.0, 0.4)
        lambert = np.clip((normals @ to_lamp + soft) / (1.0 + soft), 0.0, None)
        light = light + strength * lambert[:, None] * np.exp(rng.normal(0.0, 0.08, 3))
        halfway = to_lamp + np.array([0.0, 0.0, -1.0])
        halfway /= np.linalg.norm(halfway)
        shine = np.clip(normals @ halfway, 0.0, 1.0) ** rng.uniform(8.0, 50.0)
        light = light + 0.6 * (gloss * strength * shine)[:, None] / np.maximum(albedo, 0.05)
    farthest = drawn.depth[rows, columns].max()
    depth = np.minimum(drawn.depth, farthest).astype(np.float32)
    for reach, nats in OCCLUSION:
        behind = np.clip(depth - cv2.GaussianBlur(depth, (0, 0), reach), 0.0, 0.08)[rows, columns]
        light = light * np.exp(-nats * rng.uniform(0.5, 1.6) * behind)[:, None]
    return albedo * light


def photographed(
    light: Float[np.ndarray, "h w 3"], rng: np.random.Generator
) -> UInt8[np.ndarray, "h w 3"]:
    """Linear light as a camera stores it: blurred, noisy, toned, sharpened, compressed."""
    seen = light.astype(np.float32)
    if rng.random() < 0.4:
        seen = cv2.GaussianBlur(seen, (0, 0), rng.uniform(0.3, 1.2))
    seen = seen * (1.0 + rng.uniform(0.0, 0.06) * rng.normal(size=seen.shape))
    seen = np.maximum(seen + rng.uniform(0.0, 0.01) * rng.normal(size=seen.shape), 0.0)
    if rng.random() < 0.5:
        seen = seen / (1.0 + rng.uniform(0.0, 0.5) * seen)
    shown = np.clip(seen, 0.0, 1.0) ** (1.0 / 2.2)
    if rng.random() < 0.5:
        shown = 0.5 + (shown - 0.5) * rng.uniform(0.8, 1.35)
    if rng.random() < 0.25:
        shown = shown + rng.uniform(0.3, 1.0) * (shown - cv2.GaussianBlur(shown, (0, 0), 1.2))
    if rng.random() < 0.3:
        grey = shown.mean(axis=2, keepdims=True)
        shown = grey + (shown - grey) * rng.uniform(0.3, 1.4)
    stored = (255.0 * np.clip(shown, 0.0, 1.0)).astype(np.uint8)
    if rng.random() < 0.6:
        quality = [cv2.IMWRITE_JPEG_QUALITY, int(rng.uniform(40.0, 95.0))]
        coded = cv2.imencode(".jpg", stored, quality)[1]
        return np.asarray(cv2.imdecode(coded, cv2.IMREAD_COLOR), dtype=np.uint8)
    return stored


LABEL_COLOURS: Final = np.array(
    [(255, 255, 255), (128, 128, 128), (255, 128, 0), (128, 0, 255), (50, 180, 50), (0, 128, 255)],
    np.uint8,
)
"""Of contact sheets, in the order of :class:`~fitter.detection.worn_parts.WornPart`."""
