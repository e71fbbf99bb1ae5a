"""All of the paper's figures, and Table 1: one person in three poses, and the truth."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from jaxtyping import Float

from fitter.arrays import Triangles, Vertices
from fitter.export.antialiasing import render_finely, vertex_pictures
from fitter.export.display import to_levels
from fitter.export.views import CLAY, before_onlooker, coloured_body, middle_of
from fitter.render.camera import Camera
from fitter.reproduction.looks import figure_6, figure_7, figure_9, figure_10
from fitter.reproduction.method import figure_2, figure_3, figure_4, figure_5, fitted
from fitter.reproduction.panels import (
    GREEN,
    RED,
    Figure,
    Levels,
    common_camera,
    in_profile,
    row,
    stacked,
)
from fitter.request import FitRequest, Paper
from fitter.result import FitResult, FitStage
from fitter.vocabulary.choices import Cues

BY_PAPER: Final = "by the paper's method"
BY_OURS: Final = "by this package's method"

HIDING: Final = "occluded"
"""The subject's pose in which an arm hides part of the trunk."""

COLUMNS: Final = (
    ("Chest size (cm)", "chest_girth"),
    ("Waist size (cm)", "waist_girth_navel"),
    ("Body weight (kg)", "weight"),
)
"""Columns of the paper's Table 1, in its order."""

_WORST_CM: Final = 5.0
_STOPS: Final = np.array(
    [[0.05, 0.10, 0.75], [0.05, 0.60, 0.80], [0.15, 0.65, 0.15], [0.95, 0.80, 0.10],
     [0.85, 0.10, 0.05], [0.40, 0.02, 0.45]]
)  # fmt: skip
"""Linear colours of displacements of 0, 1 ... 5 cm."""

_HEIGHT_PX: Final = 300
_BODY_PX: Final = 150


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Subject:
    """Somebody whose body is known, in pictures of several poses by name.

    Attributes
    ----------
    requests
        Of the pictures.
    posed
        (m, 3) the true bodies, camera frame, metres.
    canonical
        (m, 3) the true body in the canonical pose, body frame, metres.
    measurements
        The true ones by name, centimetres and kilograms.
    """

    requests: Mapping[str, FitRequest]
    posed: Mapping[str, Vertices]
    canonical: Vertices
    measurements: Mapping[str, float]


Sizes = tuple[tuple[float, float, float], ...]
"""SE, SES and truth of each column."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Table 1: of each pose the three columns, by one method."""

    title: str
    rows: tuple[Sizes, ...]


PRINTED_TABLE: Final = Table(
    title="as the paper prints it",
    rows=(
        ((95.7, 92.7, 92.6), (86.4, 79.6, 80.2), (72.0, 65.4, 63.8)),
        ((84.3, 87.1, 91.6), (83.7, 78.5, 79.4), (62.5, 62.4, 63.2)),
        ((95.4, 91.9, 91.4), (88.0, 76.9, 80.3), (70.8, 63.5, 62.6)),
    ),
)


def table_1(title: str, subject: Subject, results: Sequence[FitResult]) -> Table:
    """Measurements of fits of the subject's pictures."""

    def sizes(result: FitResult) -> Sizes:
        stages = (_outline_stage(result), result.stages[-1])
        found = [{each.name: each.value for each in stage.measurements} for stage in stages]
        return tuple(
            (found[0][name], found[1][name], subject.measurements[name]) for _, name in COLUMNS
        )

    return Table(title=title, rows=tuple(sizes(result) for result in results))


def table_markdown(table: Table) -> str:
    """Table 1 by one method, as Markdown."""
    heads = [f"{title} {kind}" for title, _ in COLUMNS for kind in ("SE", "SES", "GT")]
    rows = [["", *heads], ["---:"] * (1 + len(heads))]
    rows += [
        [f"Pose {number}", *table_cells(row)] for number, row in enumerate(table.rows, start=1)
    ]
    lines = "".join(f"| {' | '.join(row)} |\n" for row in rows)
    return f"**Table 1 {table.title}**\n\n{lines}"


def table_cells(row: Sizes) -> list[str]:
    """A pose's cells, with deviations from the truth."""
    return [
        cell
        for se, ses, true in row
        for cell in (_with_deviation(se, true), _with_deviation(ses, true), f"{true:.1f}")
    ]


def _with_deviation(value: float, true: float) -> str:
    # Adding zero leaves no "-0.0".
    return f"{value:.1f} ({round(value - true, 1) + 0.0:+.1f})"


def figure_8(name: str, title: str, subject: Subject, results: Sequence[FitResult]) -> Figure:
    """First body, SE, SES and the truth of every pose, with displacements from the truth."""
    rows: list[Levels] = []
    means: list[tuple[float, float]] = []
    for (pose, posed), result in zip(subject.posed.items(), results, strict=True):
        errors = [
            displacements_m(each.canonical_vertices, subject.canonical)
            for each in (_outline_stage(result), result.stages[-1])
        ]
        means.append((1000.0 * errors[0].mean(), 1000.0 * errors[1].mean()))
        rows.append(_row_of(pose, posed, result, errors))
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
    pose: str, true: Vertices, result: FitResult, errors: Sequence[Float[np.ndarray, " m"]]
) -> Levels:
    (view,), triangles = result.views, result.triangles
    stages = (result.stages[0], _outline_stage(result), result.stages[-1])
    found = [stage.bodies[0] for stage in stages]
    front = [*(each.posed_vertices for each in found), true]
    roots = [*(each.body.translation for each in found), true.mean(axis=0)]
    tilt = view.found.person.tilt
    side = [in_profile(posed, root, tilt) for posed, root in zip(front, roots, strict=True)]
    beside = common_camera(side, width=_BODY_PX)
    colours = (CLAY, RED, GREEN, CLAY)
    seen: list[Levels] = []
    aside: list[Levels] = []
    for posed, turned, colour in zip(front, side, colours, strict=True):
        # The true camera may be another than the one that was assumed.
        own = common_camera([posed], width=_BODY_PX)
        seen.append(coloured_body(posed, triangles, own, colour))
        aside.append(coloured_body(turned, triangles, beside, colour))
    canonical = [each.canonical_vertices for each in stages[1:]]
    at_rest = [before_onlooker(each, middle_of(each), 0.0) for each in canonical]
    resting = common_camera(at_rest, width=_BODY_PX + 20)
    maps = [
        (f"off {1000 * error.mean():.0f} mm", _error_map(rest, triangles, error, resting))
        for rest, error in zip(at_rest, errors, strict=True)
    ]
    panels = [(pose, to_levels(view.pictures.image)), ("first body", seen[0])]
    for stage, name in ((1, "SE"), (2, "SES")):
        panels += [(name, seen[stage]), ("from the right", aside[stage]), maps[stage - 1]]
    panels += [("truth", seen[3]), ("from the right", aside[3])]
    return row(panels, height_px=_HEIGHT_PX)


def _error_map(
    vertices: Vertices, triangles: Triangles, error_m: Float[np.ndarray, " m"], camera: Camera
) -> Levels:
    at = np.clip(100.0 * error_m / _WORST_CM, 0.0, 1.0) * (len(_STOPS) - 1)
    low = np.minimum(at.astype(int), len(_STOPS) - 2)
    share = (at - low)[:, None]
    colours = (1.0 - share) * _STOPS[low] + share * _STOPS[low + 1]
    (levels,) = vertex_pictures([colours], render_finely(vertices, triangles, camera))
    return levels


def _outline_stage(result: FitResult) -> FitStage:
    """The stage by silhouette and edges; the last one where there is none of it."""
    return next((each for each in result.stages if each.name == "SE"), result.stages[-1])


def reproduce(
    portrait: FitRequest,
    subject: Subject,
    drawn: Callable[[Figure], None],
    *,
    painting: FitRequest | None = None,
) -> tuple[Table, ...]:
    """Draw everything; return Table 1 by the paper's method, by this package's, and as printed.

    Parameters
    ----------
    portrait
        One person, of Figs. 2, 3, 5, 7 and 9.
    subject
        Of Figs. 4 and 8 and of Table 1.
    drawn
        Receives each figure as soon as it is there.
    painting
        Of Fig. 10; without one there is none.

    Raises
    ------
    InvalidInputError
        If a picture cannot be used.
    """
    plain = fitted(portrait, Cues.SE, Paper())
    drawn(figure_2(portrait, plain))
    drawn(figure_3(plain))
    drawn(figure_4(subject.requests[HIDING]))
    drawn(figure_5(portrait, plain))
    drawn(figure_6())
    shaded = fitted(portrait, Cues.SES)
    drawn(figure_7(shaded))
    by_paper = [fitted(each, Cues.SES, Paper()) for each in subject.requests.values()]
    ours = [fitted(each, Cues.SES) for each in subject.requests.values()]
    drawn(figure_8("figure_8", f"Figure 8: SE and SES, {BY_PAPER}", subject, by_paper))
    drawn(figure_8("figure_8_ours", f"Figure 8 once more, {BY_OURS}", subject, ours))
    drawn(figure_9(portrait, shaded))
    if painting is not None:
        drawn(figure_10(painting, fitted(painting, Cues.SES)))
    return (
        table_1(BY_PAPER, subject, by_paper),
        table_1(BY_OURS, subject, ours),
        PRINTED_TABLE,
    )
