"""Fig. 8 and Table 1: one person in three poses, by the outline and by shading, and the truth."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import Triangles, Vertices
from fitter.body.scape import CAMERA_AXES
from fitter.export.antialiasing import render_finely, vertex_pictures
from fitter.export.display import to_levels
from fitter.export.views import CANONICAL_DISTANCE_M
from fitter.render.camera import Camera
from fitter.reproduction.panels import (
    GREEN,
    RED,
    Figure,
    Levels,
    coloured_body,
    common_camera,
    in_profile,
    row,
    stacked,
)
from fitter.request import FitRequest
from fitter.result import FitResult, FitStage

COLUMNS: Final = (
    ("Chest size (cm)", "chest_girth"),
    ("Waist size (cm)", "waist_girth_navel"),
    ("Body weight (kg)", "weight"),
)
"""Of the paper's Table 1, in its order."""

PRINTED: Final = (
    ((95.7, 92.7, 92.6), (86.4, 79.6, 80.2), (72.0, 65.4, 63.8)),
    ((84.3, 87.1, 91.6), (83.7, 78.5, 79.4), (62.5, 62.4, 63.2)),
    ((95.4, 91.9, 91.4), (88.0, 76.9, 80.3), (70.8, 63.5, 62.6)),
)
"""Table 1 as the paper prints it: SE, SES and GT of each column, for each pose."""

_WORST_CM: Final = 5.0
_STOPS: Final = np.array(
    [[0.05, 0.10, 0.75], [0.05, 0.60, 0.80], [0.15, 0.65, 0.15], [0.95, 0.80, 0.10],
     [0.85, 0.10, 0.05], [0.40, 0.02, 0.45]]
)  # fmt: skip
"""Linear colours of displacements of 0, 1 ... 5 cm."""

_HEIGHT_PX: Final = 300
_BODY_PX: Final = 150


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class PosedTruth:
    """One picture of the subject.

    Attributes
    ----------
    name
        Of the pose.
    request
        Of the picture.
    posed
        (m, 3) the true body in the camera frame, metres.
    """

    name: str
    request: FitRequest
    posed: Vertices


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Subject:
    """Somebody whose body is known.

    Attributes
    ----------
    pictures
        Of several poses.
    canonical
        (m, 3) the true body in the canonical pose, body frame, metres.
    measurements
        The true ones by name, centimetres and kilograms.
    """

    pictures: tuple[PosedTruth, ...]
    canonical: Vertices
    measurements: Mapping[str, float]


Sizes = tuple[tuple[float, float, float], ...]
"""SE, SES and truth of each column."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Table 1: of each pose the three columns, by one method."""

    title: str
    rows: tuple[Sizes, ...]


def table_1(title: str, subject: Subject, results: Sequence[FitResult]) -> Table:
    """Measurements of fits of the subject's pictures."""
    return Table(
        title=title,
        rows=tuple(
            tuple(
                (
                    _measured(_stage(result, "SE"), name),
                    _measured(result.stages[-1], name),
                    subject.measurements[name],
                )
                for _, name in COLUMNS
            )
            for result in results
        ),
    )


def figure_8(name: str, title: str, subject: Subject, results: Sequence[FitResult]) -> Figure:
    """First body, SE, SES and the truth of every pose, with displacements from the truth."""
    rows: list[Levels] = []
    means: list[tuple[float, float]] = []
    for picture, result in zip(subject.pictures, results, strict=True):
        errors = [
            displacements_m(each.canonical_vertices, subject.canonical)
            for each in (_stage(result, "SE"), result.stages[-1])
        ]
        means.append((1000.0 * errors[0].mean(), 1000.0 * errors[1].mean()))
        rows.append(_row_of(picture, result, errors))
    by_outline, shaded = (np.mean([each[k] for each in means]) for k in range(2))
    return Figure(
        name=name,
        title=title,
        caption=(
            "Three poses, from left to right: picture; first body; SE (red) from the "
            "camera, from the right, and its displacement from the truth at rest; the same of SES "
            "(green); the truth. Blue is no displacement, purple 5 cm and more. Vertices are "
            f"{by_outline:.1f} mm off by SE and {shaded:.1f} mm by SES, on the mean of all poses."
        ),
        differs=(
            "The truth is the mesh that the pictures were rendered from, by another renderer and "
            "another maker's rig, not the same model fitted to eight cameras. Camera and light "
            "differ from pose to pose."
        ),
        picture=stacked(rows),
    )


def displacements_m(found: Vertices, true: Vertices) -> Float[np.ndarray, " m"]:
    """Distance of each vertex from the truth, metres, with both bodies' centres together."""
    off = (found - found.mean(axis=0)) - (true - true.mean(axis=0))
    return np.linalg.norm(off, axis=1)


def _row_of(
    picture: PosedTruth, result: FitResult, errors: Sequence[Float[np.ndarray, " m"]]
) -> Levels:
    (view,), triangles = result.views, result.triangles
    tilt, outline = view.found.person.tilt, _stage(result, "SE")
    bodies = [
        (result.stages[0].bodies[0].posed_vertices, result.stages[0].bodies[0].body.translation),
        *(
            (each.bodies[0].posed_vertices, each.bodies[0].body.translation)
            for each in (outline, result.stages[-1])
        ),
        (picture.posed, picture.posed.mean(axis=0)),
    ]
    front = [posed for posed, _ in bodies]
    side = [in_profile(posed, root, tilt) for posed, root in bodies]
    # The true camera may be another than the one that was assumed.
    own = [common_camera([each], width=_BODY_PX) for each in front]
    beside = common_camera(side, width=_BODY_PX)

    def seen(index: int, colour: Float[np.ndarray, "3"] | None) -> list[tuple[str, Levels]]:
        given = () if colour is None else (colour,)
        return [
            ("", coloured_body(front[index], triangles, own[index], *given)),
            ("from the right", coloured_body(side[index], triangles, beside, *given)),
        ]

    stages = (outline, result.stages[-1])
    at_rest = [_at_rest(each.canonical_vertices) for each in stages]
    resting = common_camera(at_rest, width=_BODY_PX + 20)
    maps = [
        _error_map(rest, triangles, error, resting)
        for rest, error in zip(at_rest, errors, strict=True)
    ]
    first, _ = seen(0, None)
    (_, se), se_side = seen(1, RED)
    (_, ses), ses_side = seen(2, GREEN)
    (_, true), true_side = seen(3, None)
    return row(
        [
            (picture.name, to_levels(view.pictures.image)),
            ("first body", first[1]),
            ("SE", se),
            se_side,
            (f"off {1000 * errors[0].mean():.0f} mm", maps[0]),
            ("SES", ses),
            ses_side,
            (f"off {1000 * errors[1].mean():.0f} mm", maps[1]),
            ("truth", true),
            true_side,
        ],
        height_px=_HEIGHT_PX,
    )


def _error_map(
    vertices: Vertices, triangles: Triangles, error_m: Float[np.ndarray, " m"], camera: Camera
) -> Levels:
    at = np.clip(100.0 * error_m / _WORST_CM, 0.0, 1.0) * (len(_STOPS) - 1)
    low = np.minimum(at.astype(int), len(_STOPS) - 2)
    share = (at - low)[:, None]
    colours = (1.0 - share) * _STOPS[low] + share * _STOPS[low + 1]
    (levels,) = vertex_pictures([colours], render_finely(vertices, triangles, camera))
    return levels


def _at_rest(canonical: Vertices) -> Vertices:
    """Before a camera."""
    middle = 0.5 * (canonical.max(axis=0) + canonical.min(axis=0))
    return (canonical - middle) * CAMERA_AXES + [0.0, 0.0, CANONICAL_DISTANCE_M]


def _stage(result: FitResult, name: str) -> FitStage:
    """A stage by its name; the last one where there is none of it."""
    return next((each for each in result.stages if each.name == name), result.stages[-1])


def _measured(stage: FitStage, name: str) -> float:
    return next(each.value for each in stage.measurements if each.name == name)
