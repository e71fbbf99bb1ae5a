"""What a fit's cost grows with: size of the picture, starts, vertices, pictures of a scan.

What more processes make of it says :mod:`tests.benchmarks.throughput`.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import qdldl
import trimesh
from scipy import sparse

from fitter.energies.fitting_operators import FittingOperators
from fitter.fits import equipment, outlined
from fitter.fits.prepared_model import PreparedModel, prepared_model
from fitter.fits.progress import Stage
from fitter.numerics.gradient_operators import gradient_operator, part_laplacians
from fitter.numerics.mesh_topology import mesh_topology
from fitter.numerics.sparse_factor import sparse_factor
from fitter.optimizer.search import limits_of
from fitter.render.camera import Camera
from fitter.render.contours import model_edges
from fitter.render.rasterizer import render
from fitter.training.report.text_tables import note_lines, table_lines
from fitter.vocabulary.choices import Gender
from tests.benchmarks.probe import requests_of, scan_share
from tests.benchmarks.requests import suite_requests, warm_up
from tests.benchmarks.spent import TimedFit, median, timed, timed_fit
from tests.evaluation.phone_cases import REPEATED_PAIRS, PhonePair

WIDTHS = (240, 360, 480, 960, 1920, 3000)
STARTS = (1, 2, 3, 4)
SUBDIVISIONS = (3, 4, 5, 6)
VIEWS = (2, 4)
CAMERA = Camera(focal_length_px=800, centre_x=240, centre_y=320, width=480, height=640)
_CALLS = 20


def lines(count: int) -> Iterator[str]:
    """Five tables."""
    warm_up()
    yield from _by_picture(count)
    yield from _by_starts(count)
    yield from _by_body(count)
    yield from _by_vertices()
    yield from _by_views(count)


def _by_picture(count: int) -> Iterator[str]:
    rows: list[tuple[str, ...]] = []
    for width in WIDTHS:
        height = width * 4 // 3
        fits = [timed_fit(each) for each in suite_requests(count, width=width, height=height)]
        camera = fits[0].result.views[0].camera
        observed = [each.stages[Stage.OBSERVATION].processor_s for each in fits]
        rows.append(
            (
                f"{width}x{height}",
                f"{camera.width}x{camera.height}",
                f"{median(observed):.3f}",
                f"{_whole(fits) - median(observed):.2f}",
                f"{_whole(fits):.2f}",
            )
        )
    yield from table_lines(
        f"Size of the picture, median processor seconds of {count} fits",
        ("picture", "worked on at", "reading it", "the rest", "in all"),
        rows,
    )


def _by_starts(count: int) -> Iterator[str]:
    rows: list[tuple[str, ...]] = []
    for starts in STARTS:
        with _at_most(starts):
            fits = [timed_fit(each) for each in suite_requests(count, width=480, height=640)]
        searched = [each.stages[Stage.SILHOUETTE_AND_EDGES].processor_s for each in fits]
        energies = [sum(each.result.energies.values()) for each in fits]
        evaluations = [float(each.result.evaluations) for each in fits]
        rows.append(
            (
                str(starts),
                f"{median(searched):.2f}",
                f"{_whole(fits):.2f}",
                f"{median(evaluations):.0f}",
                f"{np.mean(energies):.1f}",
            )
        )
    yield from table_lines(
        f"Readings of the clicks tried at most, medians of {count} fits, processor seconds",
        ("starts", "silhouette_and_edges", "in all", "energies computed", "mean final energy"),
        rows,
    )


@contextmanager
def _at_most(starts: int) -> Iterator[None]:
    """Fits in this context try so many readings of the clicks at most."""
    outlined.limits_of = lambda kind: replace(
        limits_of(kind), hypotheses=starts, contenders=min(starts, limits_of(kind).contenders)
    )
    try:
        yield
    finally:
        outlined.limits_of = limits_of


def _by_body(count: int) -> Iterator[str]:
    requests = suite_requests(count, width=480, height=640)
    prepared = prepared_model(requests[0].person.gender)
    lighter = [timed_fit(each) for each in requests]
    with _on_whole_body():
        # What the whole body alone has at first use.
        timed_fit(requests[0])
        whole = [timed_fit(each) for each in requests]
    yield from table_lines(
        f"Vertices of the body that is searched for, medians of {count} fits, processor seconds",
        ("vertices", "silhouette_and_edges", "shading", "in all", "mean final energy"),
        [_body_row(prepared.searched, lighter), _body_row(prepared.operators, whole)],
    )
    yield from note_lines("Searches use the lighter body, drawings and results the whole one.")


def _body_row(operators: FittingOperators, fits: Sequence[TimedFit]) -> tuple[str, ...]:
    stages = (Stage.SILHOUETTE_AND_EDGES, Stage.SHADING)
    return (
        f"{len(operators.model.mean_vertices):,}",
        *(f"{median([each.stages[stage].processor_s for each in fits]):.2f}" for stage in stages),
        f"{_whole(fits):.2f}",
        f"{np.mean([sum(each.result.energies.values()) for each in fits]):.1f}",
    )


@contextmanager
def _on_whole_body() -> Iterator[None]:
    """Fits in this context search for the whole body."""

    def whole(gender: Gender, *, models: Path | None = None) -> PreparedModel:
        prepared = prepared_model(gender, models=models)
        return replace(prepared, searched=prepared.operators)

    equipment.prepared_model = whole
    try:
        yield
    finally:
        equipment.prepared_model = prepared_model


def _by_vertices() -> Iterator[str]:
    rows = [_vertex_row(subdivisions) for subdivisions in SUBDIVISIONS]
    yield from table_lines(
        "Number of vertices, one egg in 480x640, median processor milliseconds a call",
        ("vertices", "render", "model edges", "least squares, 3 columns"),
        rows,
    )
    yield from note_lines(
        "A body has 12,440 vertices. These are the parts of an energy that work on every vertex; "
        "the terms of shape and pose grow in proportion to vertices as well."
    )


def _by_views(count: int) -> Iterator[str]:
    scans = [
        [*requests_of(one), *requests_of(other)] for one, other in _pairs_of_one_person()[:count]
    ]
    rows = [("1", "1.00", "1.00")]
    for views in VIEWS:
        share = median([scan_share(each[:views]) for each in scans])
        rows.append((str(views), f"{share:.2f}", f"{share / views:.2f}"))
    yield from table_lines(
        f"Pictures of a scan, medians of {len(scans)} scans, processor time over a single fit's",
        ("pictures", "in all", "a picture"),
        rows,
    )
    yield from note_lines(
        "Front and side; then front and side again, in another room and stance. One picture is a "
        "fit, by silhouette, edges and shading as the scans are."
    )


def _pairs_of_one_person() -> list[tuple[PhonePair, PhonePair]]:
    """Each pair of a person with the next of the same."""
    pairs = pairwise(REPEATED_PAIRS.values())
    return [(one, other) for one, other in pairs if one.person == other.person]


def _vertex_row(subdivisions: int) -> tuple[str, ...]:
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions)
    vertices = np.array(mesh.vertices) * [0.5, 0.95, 0.4] + [0.0, 0.0, 3.2]
    triangles = np.array(mesh.faces)
    topology = mesh_topology(triangles, vertex_count=len(vertices))
    rendering = render(vertices, triangles, CAMERA)
    gradient = gradient_operator(vertices, triangles)
    one_part = np.zeros(len(triangles), dtype=np.int64)
    (laplacian,) = part_laplacians(gradient, np.ones(len(triangles)), one_part, 1)
    matrix = sparse.lil_array(laplacian)
    matrix[0, 0] += matrix.diagonal().mean()
    lower, diagonal, permutation = qdldl.Solver(sparse.csc_matrix(matrix)).factors()
    factor = sparse_factor(sparse.csc_matrix(lower), diagonal, permutation)
    actions: Sequence[Callable[[], object]] = (
        lambda: render(vertices, triangles, CAMERA),
        lambda: model_edges(rendering, topology),
        lambda: factor.solve(vertices),
    )
    return (f"{len(vertices):,}", *(f"{_milliseconds(action):.2f}" for action in actions))


def _milliseconds(action: Callable[[], object]) -> float:
    action()
    return 1e3 * median([timed(action)[1].processor_s for _ in range(_CALLS)])


def _whole(fits: Sequence[TimedFit]) -> float:
    return median([each.whole.processor_s for each in fits])
