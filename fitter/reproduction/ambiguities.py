"""Figs. 4 and 5: what a silhouette alone cannot tell, and what edges and the height add."""

from dataclasses import replace

import cv2
import numpy as np

from fitter.energies.fitting_operators import FittingOperators
from fitter.evidence.edge_cost import edge_cost_map
from fitter.export.display import to_levels
from fitter.fits.pipeline import fit
from fitter.fits.prepared_model import prepared_model
from fitter.render.contours import model_edges
from fitter.render.rasterizer import render
from fitter.reproduction.panels import (
    GREEN,
    MAGENTA,
    RED,
    Figure,
    Levels,
    coloured_body,
    common_camera,
    in_profile,
    overlaps,
    row,
    stacked,
)
from fitter.request import FitRequest, Paper
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues, PaperEnergy
from fitter.vocabulary.measurements import STATURE

_EDGE_LINE = (230, 30, 30)
_EDGE_THRESHOLD_M = 0.03
_WITHOUT_EDGES = frozenset({PaperEnergy.SILHOUETTE, PaperEnergy.PENETRATION})


def figure_4(request: FitRequest) -> Figure:
    """Without and with the edges of the picture: of somebody part of whom hides another."""
    without = fit_by_paper(request, Paper(energies=_WITHOUT_EDGES))
    with_edges = fit_by_paper(request, Paper())
    operators = prepared_model(request.person.gender).operators
    found = (without, with_edges)
    seen = [
        in_profile(
            each.found.posed_vertices, each.person.body.translation, each.person.tilt, degrees=60.0
        )
        for each in found
    ]
    camera = common_camera(seen)
    rows = [
        row(
            [
                ("picture", to_levels(each.views[0].pictures.image)),
                ("edge cost, the body's edges", _edges_over_cost(each, operators)),
                ("overlap", _overlap(each)),
                (title, coloured_body(body, each.triangles, camera, colour)),
            ]
        )
        for each, body, title, colour in zip(
            found,
            seen,
            ("silhouette alone, from the right", "with edges, from the right"),
            (RED, GREEN),
            strict=True,
        )
    ]
    costs = [each.energies["silhouette"] for each in found]
    return Figure(
        name="figure_4",
        title="Figure 4: edges inside the silhouette",
        caption=(
            "Above, a fit by silhouette and penetration; below, by edges too. The body's edges "
            "(red) over the cost of edges of the picture (dark is cheap); the overlap of both "
            "silhouettes (yellow), with what the picture has alone (blue) and the body alone "
            f"(red); the body from the right. The silhouette costs {costs[0]:.1f} nats above and "
            f"{costs[1]:.1f} below."
        ),
        differs=(
            "Terms have the weights of this package. A rendered person in a room takes the place "
            "of the laboratory's."
        ),
        picture=stacked(rows),
    )


def figure_5(request: FitRequest, held: FitResult) -> Figure:
    """The height free and held, of the same picture; ``held`` is the fit by E1 that holds it."""
    free = fit_by_paper(request, Paper(free_height=True))
    bodies = (free, held)
    front = [each.found.posed_vertices for each in bodies]
    side = [
        in_profile(each.found.posed_vertices, each.person.body.translation, each.person.tilt)
        for each in bodies
    ]
    heights = [
        next(each.value for each in result.stages[-1].measurements if each.name == STATURE)
        for result in bodies
    ]
    in_front, beside = common_camera(front), common_camera(side)
    triangles = held.triangles
    panels: list[tuple[str, Levels]] = [("picture", to_levels(held.views[0].pictures.image))]
    for label, colour, index in (("free", MAGENTA, 0), ("held", GREEN, 1)):
        title = f"height {label}: {heights[index]:.0f} cm"
        panels += [
            (title, coloured_body(front[index], triangles, in_front, colour)),
            ("from the right", coloured_body(side[index], triangles, beside, colour)),
        ]
    return Figure(
        name="figure_5",
        title="Figure 5: the height, free and held",
        caption=(
            "Fits of one picture by silhouette, edges and penetration. With the height free "
            f"(magenta) the silhouettes overlap by {100 * free.found.silhouette_overlap:.1f} %, "
            f"with the height held (green) by {100 * held.found.silhouette_overlap:.1f} %: from "
            "the camera both explain the picture, from the side they differ."
        ),
        differs=(
            "Perspective ties size to distance: a taller body stands farther away. How much the "
            "bodies differ depends on the picture."
        ),
        picture=row(panels),
    )


def fit_by_paper(request: FitRequest, paper: Paper, cues: Cues = Cues.SE) -> FitResult:
    """Fit a picture by the paper's method."""
    return fit(
        replace(
            request,
            views=tuple(replace(view, cues=cues) for view in request.views),
            choices=replace(request.choices, paper=paper, force=True),
        )
    )


def _edges_over_cost(result: FitResult, operators: FittingOperators) -> Levels:
    (view,) = result.views
    body = view.found.person.body
    pixels_per_metre = view.camera.focal_length_px / float(body.translation[2])
    cost = edge_cost_map(
        view.pictures.image, threshold_px=_EDGE_THRESHOLD_M * pixels_per_metre
    ).cost
    levels = np.ascontiguousarray(np.repeat(to_levels(cost)[..., None], 3, axis=2))
    rendering = render(view.found.posed_vertices, result.triangles, view.camera)
    edges = model_edges(rendering, operators.topology)
    for start, end in np.rint(edges.endpoints[edges.visible] - 0.5).astype(int):
        cv2.line(levels, start.tolist(), end.tolist(), _EDGE_LINE, 2, cv2.LINE_AA)
    return levels


def _overlap(result: FitResult) -> Levels:
    (view,) = result.views
    body = render(view.found.posed_vertices, result.triangles, view.camera).silhouette
    return overlaps(body, view.pictures.segmentation)
