"""Clothes of a case as meshes: the training's garments (:mod:`fitter.training.dressed`), cut and
coloured as the case says."""

from collections.abc import Iterator, Sequence

import numpy as np
from jaxtyping import Float
from scipy.spatial import KDTree

from fitter.detection.worn_parts import WornPart
from fitter.training.dressed.bodies import StandingBody, rest_body
from fitter.training.dressed.garments import (
    SKIRT_RANK,
    TOP_RANK,
    LegsCut,
    UpperCut,
    hung,
    legs,
    neckline,
    upper,
)
from fitter.training.dressed.heads_and_feet import SHOE_RANK, shod
from fitter.training.dressed.outer_garments import OUTER_RANK, front_gap
from fitter.training.dressed.pictures import FOLD_M, fold_heights
from fitter.training.dressed.surfaces import Hang, Layer, Paint, Places, noise, smooth_step
from tests.accuracy.looks import CLOTH_ROUGHNESS
from tests.accuracy.meshes import PersonMesh, vertex_normals
from tests.accuracy.people import landmarks_on
from tests.accuracy.scene import Bottom, Cloth, Label, Outfit, Pattern, Shoes, Top
from tests.accuracy.staging import Staged, root_joint

REPEAT_M = 0.07
"""Distance from one stripe to the next."""

WEAVE = 0.06

APART_M, NEAR_M = 0.005, 0.03
"""Cloth lies so far over what is under it, and over what is so near."""

SHOE_EASE_M = 0.008


def garment_meshes(staged: Staged, rng: np.random.Generator) -> list[PersonMesh]:
    """The outfit of a case as meshes in the world, none without one."""
    outfit = staged.case.outfit
    if outfit is None:
        return []
    body, root = _body(staged), root_joint(staged)
    under, meshes = [(staged.body, vertex_normals(staged.body, body.rest.model.triangles))], []
    for label, layer in sorted(_layers(body, outfit, rng), key=lambda each: each[1].rank):
        mesh = _mesh(layer, root, label, under, rng)
        used = np.unique(mesh.triangles)
        under.append((mesh.vertices[used], mesh.normals[used]))
        meshes.append(mesh)
    return meshes


def _body(staged: Staged) -> StandingBody:
    gender = staged.person.gender
    rest, vertices = rest_body(gender), staged.body - root_joint(staged)
    return StandingBody(
        rest=rest,
        vertices=vertices,
        normals=vertex_normals(vertices, rest.model.triangles),
        marks=landmarks_on(gender, vertices),
    )


def _layers(
    body: StandingBody, outfit: Outfit, rng: np.random.Generator
) -> Iterator[tuple[Label, Layer]]:
    tops = (outfit.top, Label.LOWER if outfit.bottom is None else Label.UPPER, TOP_RANK)
    for top, label, rank in (tops, (outfit.jacket, Label.UPPER, OUTER_RANK)):
        if top is not None:
            yield from (
                (label, each) for each in upper(body, _upper_cut(body, top, rank, rng), rng)
            )
    if outfit.bottom is not None:
        yield from ((Label.LOWER, each) for each in _bottom(body, outfit.bottom, rng))
    if outfit.shoes is not None:
        yield Label.SHOES, _shoes(body, outfit.shoes, rng)


def _upper_cut(body: StandingBody, top: Top, rank: float, rng: np.random.Generator) -> UpperCut:
    ease, cuffed = top.cloth.ease_m, top.cuffs
    return UpperCut(
        part=WornPart.CLOTH,
        paint=_paint(top.cloth, rng),
        rank=rank,
        ease_m=0.5 * ease,
        hang=lambda share: ease * np.where(cuffed & (share > 0.93), 0.2, 1.0),
        hem=_height(body, top.hem),
        sleeve=top.sleeve - 0.02,
        neck=neckline(body, "scoop", top.neckline_m, 0.08),
        fall=top.cloth.fall,
        drop_m=0.02,
        folds=top.cloth.fold_m / FOLD_M,
        opening=front_gap(body, rng, 0.6 * top.opening_m) if top.opening_m > 0.0 else None,
    )


def _bottom(body: StandingBody, bottom: Bottom, rng: np.random.Generator) -> list[Layer]:
    cloth, paint = bottom.cloth, _paint(bottom.cloth, rng)
    waist, hem = _height(body, bottom.waist), _height(body, bottom.hem)
    folds = cloth.fold_m / FOLD_M
    if not bottom.skirt:
        cut = LegsCut(
            paint=paint,
            waist=waist,
            hem=hem,
            close_m=min(0.012, 0.5 * cloth.ease_m),
            tube_m=cloth.ease_m,
            cuffed=bottom.cuffs,
            fall=cloth.fall,
            folds=folds,
        )
        return legs(body, cut, rng)
    hang = Hang(
        top_m=waist * body.scale,
        hem_m=hem * body.scale,
        ease=lambda share: cloth.ease_m * (0.3 + 0.7 * share),
        fall=cloth.fall,
    )
    about = ~body.rest.on_arms & ~body.rest.on("foot") & (body.rest.points[:, 1] < waist + 0.1)
    return hung(body, body.vertices[about], hang, paint, rng, SKIRT_RANK, folds)


def _shoes(body: StandingBody, shoes: Shoes, rng: np.random.Generator) -> Layer:
    rest = body.rest
    ankle, sole = rest.marks["left_ankle"][1], rest.floor + 0.006
    leather, rubber = np.array(shoes.colour), np.array(shoes.sole_colour)
    return Layer(
        vertices=shod(body, SHOE_EASE_M, shoes.sole_m, rng, broad=True),
        triangles=rest.triangles_of(rest.on_legs & (rest.points[:, 1] < ankle + 0.1)),
        places=rest.places(),
        part=WornPart.SHOES,
        paint=lambda at: np.where((at.y < sole)[:, None], rubber, leather),
        keeps=lambda at: at.y < ankle,
        rank=SHOE_RANK,
    )


def _height(body: StandingBody, share: float) -> float:
    """A share of the stature as a height at rest."""
    return body.rest.floor + share * float(np.ptp(body.rest.points[:, 1]))


def _paint(cloth: Cloth, rng: np.random.Generator) -> Paint:
    first, second = np.array(cloth.colour), np.array(cloth.second_colour)
    seed = int(rng.integers(1 << 30))

    def paint(at: Places) -> Float[np.ndarray, "k 3"]:
        own = np.random.default_rng(seed)
        weave = 1.0 + WEAVE * noise(own, at.points, 0.02)
        wavering = at.points + 0.004 * noise(own, at.points, 0.2)[:, None]
        share = np.zeros(len(at.x))
        if cloth.pattern is not Pattern.PLAIN:
            share = _band(wavering[:, 1])
        if cloth.pattern is Pattern.CHECKS:
            share = 0.5 * (share + _band(wavering[:, 0]))
        return np.clip((first + share[:, None] * (second - first)) * weave[:, None], 0.003, 0.9)

    return paint


def _band(along: Float[np.ndarray, " k"]) -> Float[np.ndarray, " k"]:
    return smooth_step(np.sin(2.0 * np.pi * along / REPEAT_M), -0.15, 0.15)


def _mesh(
    layer: Layer,
    root: Float[np.ndarray, "3"],
    label: Label,
    under: Sequence[tuple[np.ndarray, np.ndarray]],
    rng: np.random.Generator,
) -> PersonMesh:
    """A layer refined, cut, folded, and moved out of what is under it."""
    vertices, places, triangles = layer.vertices + root, layer.places, layer.triangles
    for _ in range(2):
        vertices, places, triangles = _refined(vertices, places, triangles)
    at = Places(*places.T)
    kept = np.ones(len(vertices), bool) if layer.keeps is None else layer.keeps(at)
    triangles = triangles[kept[triangles].all(axis=1)]
    normals = vertex_normals(vertices, triangles)
    vertices = vertices + normals * np.reshape(fold_heights(layer, at.points, rng), (-1, 1))
    for points, outward in under:
        away, nearest = map(np.asarray, KDTree(points).query(vertices))
        near = np.flatnonzero(away < NEAR_M)
        out = outward[nearest[near]]
        over = ((vertices[near] - points[nearest[near]]) * out).sum(axis=1)
        vertices[near] += np.maximum(APART_M - over, 0.0)[:, None] * out
    return PersonMesh(
        vertices=vertices,
        normals=vertex_normals(vertices, triangles),
        triangles=triangles,
        albedo=np.clip(layer.paint(at), 0.003, 0.9),
        roughness=np.full(len(vertices), CLOTH_ROUGHNESS),
        labels=np.full(len(vertices), label),
    )


def _refined(
    vertices: np.ndarray, places: np.ndarray, triangles: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Each triangle cut into four at the middles of its edges."""
    ends = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
    edges, of_triangle = np.unique(ends.reshape(-1, 2), axis=0, return_inverse=True)
    middles = len(vertices) + of_triangle.reshape(-1, 3)
    corners = [np.stack([triangles[:, k], middles[:, k], middles[:, k - 1]], 1) for k in range(3)]
    vertices, places = (
        np.concatenate([each, each[edges].mean(axis=1)]) for each in (vertices, places)
    )
    return vertices, places, np.concatenate([*corners, middles])
