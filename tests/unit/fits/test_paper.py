"""The paper's own method: its energies and nothing else, and what a fit by it says."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from fitter.energies.edges import edge_cost_map
from fitter.energies.fitting_operators import FittingOperators
from fitter.errors import InvalidInputError
from fitter.evidence.silhouette_evidence import signed_distance
from fitter.fits.equipment import prepared_model
from fitter.fits.pipeline import fit
from fitter.render.contours import model_edges
from fitter.render.rasterizer import render
from fitter.request import Choices, FitRequest, KnownMeasurement, Paper
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues, Gender, OptimizerKind, PaperEnergy
from tests.accuracy.cases import CASES
from tests.accuracy.files import read_case
from tests.accuracy.true_picture import fit_request
from tests.benchmarks.requests import resized
from tests.one_picture import together

E1 = frozenset({PaperEnergy.SILHOUETTE, PaperEnergy.EDGES, PaperEnergy.PENETRATION})
HEIGHT_CM = 164.7


def asked(paper: Paper, cues: Cues = Cues.SE) -> FitRequest:
    request = fit_request(read_case(CASES["woman_young_heavy_standing"]), cues)
    return replace(resized(request, width=300, height=400), choices=Choices(paper=paper))


def measured(result: FitResult) -> dict[str, float]:
    return {each.name: each.value for each in result.measurements}


@pytest.fixture(scope="module")
def by_outline() -> FitResult:
    return fit(asked(Paper()))


@pytest.fixture(scope="module")
def shaded() -> FitResult:
    return fit(asked(Paper(), Cues.SES))


def plain_silhouette(model: np.ndarray, mask: np.ndarray, pixels_per_metre: float) -> float:
    """The sum over unmatched pixels, from exact distances to either region at every pixel."""
    outside = cv2.distanceTransform((~model).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    distance = np.where(model, signed_distance(mask), outside)[model != mask]
    eta = 0.06 * pixels_per_metre
    cost = distance / (1.0 + (distance / eta) ** 2) ** 2
    cost = np.where(distance > eta, np.maximum(cost, 0.1 * eta), cost)
    variance = 1.0 + (0.005 * pixels_per_metre) ** 2
    return float(cost.sum()) / (variance * 0.2 * pixels_per_metre)


def plain_penetration(operators: FittingOperators, vertices: np.ndarray) -> float:
    """Half the squared overlap of every pair of spheres, in centimetres."""
    proxy, centres, radii = operators.penetration, [], []
    for index, filling in enumerate(proxy.fillings):
        span = slice(proxy.centres.pointers[index], proxy.centres.pointers[index + 1])
        ring = vertices[proxy.centres.indices[span]]
        weights = proxy.centres.weights[span]
        centres.append(weights @ ring)
        radii.append(filling * (weights @ np.linalg.norm(ring - centres[-1], axis=1)))
    overlaps = [
        max(radii[a] + radii[b] - float(np.linalg.norm(centres[a] - centres[b])), 0.0)
        for a, b in proxy.pairs
    ]
    return 0.5 * float(np.square(overlaps).sum()) / 0.01**2


def test_e1_is_the_sum_of_its_three_terms_by_plain_formulas(by_outline: FitResult):
    (view,) = by_outline.views
    operators = prepared_model(by_outline.person.gender).searched
    body, camera = by_outline.person.body, view.camera
    depth = by_outline.stages[0].bodies[0].body.translation[2]
    pixels_per_metre = camera.focal_length_px / depth
    vertices = operators.evaluator.vertices(body)
    rendering = render(vertices, operators.model.triangles, camera)
    edges = model_edges(rendering, operators.topology)
    ends = edges.endpoints[edges.visible]
    cost = edge_cost_map(view.pictures.image, threshold_px=0.03 * pixels_per_metre)
    lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    trapezoids = 0.5 * lengths * (cost.at(ends[:, 0]) + cost.at(ends[:, 1]))
    plain = {
        "silhouette": plain_silhouette(
            rendering.silhouette, view.pictures.segmentation, pixels_per_metre
        ),
        "edges": 40.0 * float(trapezoids.sum() / lengths.sum()),
        "penetration": plain_penetration(operators, vertices),
    }
    assert dict(by_outline.energies) == pytest.approx(plain, rel=1e-3, abs=1e-9)
    assert by_outline.energies["silhouette"] < by_outline.stages[0].energies["silhouette"]
    assert by_outline.found.silhouette_overlap > 0.9


def test_e2_is_e1_and_shading_and_ends_by_its_criterion(shaded: FitResult):
    assert set(shaded.energies) == {each.value for each in PaperEnergy}
    assert 0.0 < shaded.energies["shading"] < 130.0
    assert [stage.name for stage in shaded.stages] == ["initial", "SE", "SES"]
    assert set(shaded.stages[1].energies) == {each.value for each in E1}
    assert shaded.person.light is not None
    assert shaded.found.outcome.value == "converged"


@pytest.mark.parametrize("without", sorted(E1))
def test_a_term_that_is_switched_off_is_gone(by_outline: FitResult, without: PaperEnergy):
    result = fit(asked(Paper(energies=E1 - {without})))
    assert set(result.energies) == {each.value for each in E1 - {without}}
    if without is not PaperEnergy.PENETRATION:
        moved = result.found.posed_vertices - by_outline.found.posed_vertices
        assert np.linalg.norm(moved, axis=1).mean() > 0.001


def test_nothing_but_penetration_leaves_the_first_body():
    result = fit(asked(Paper(energies=frozenset({PaperEnergy.PENETRATION}))))
    first = result.stages[0].bodies[0]
    np.testing.assert_allclose(result.found.posed_vertices, first.posed_vertices, atol=1e-9)


def test_no_prior_holds_the_body_and_no_error_is_stated(by_outline: FitResult):
    ours = fit(replace(asked(Paper()), choices=Choices()))
    assert {"shape_prior", "pose_prior", "clicks"} <= set(ours.energies)
    assert np.square(by_outline.shape[1:]).sum() > np.square(ours.shape[1:]).sum()
    assert by_outline.shape_covariance is None
    assert all(each.standard_error in (None, 0.0) for each in by_outline.measurements)
    assert ours.differences == ()


def test_a_measurement_with_an_error_sets_the_first_body_and_has_no_term():
    request = asked(Paper())
    known = {"weight": KnownMeasurement(value=60.0, standard_error=0.5)}
    person = replace(request.person, measurements=known)
    result = fit(replace(request, person=person))
    assert set(result.energies) == {each.value for each in E1}
    first = {each.name: each.value for each in result.stages[0].measurements}
    assert first["weight"] == pytest.approx(60.0, abs=1.0)
    assert any("with a standard error" in each for each in result.differences)


def test_no_limb_is_ambiguous_where_no_other_reading_is_tried(by_outline: FitResult):
    (view,) = by_outline.views
    assert not any(each.ambiguous for each in view.limb_facing)
    assert "ambiguous-limb-facing" not in {each.code for each in view.warnings}


def test_the_height_is_held_unless_it_is_free(by_outline: FitResult):
    assert measured(by_outline)["stature"] == pytest.approx(HEIGHT_CM, abs=0.1)
    free = fit(asked(Paper(free_height=True)))
    assert abs(measured(free)["stature"] - HEIGHT_CM) > 0.5
    assert free.found.height_m == pytest.approx(0.01 * measured(free)["stature"], abs=1e-3)
    assert free.given == ()


def test_the_result_says_what_still_differs(by_outline: FitResult):
    assert all(each.endswith(".") for each in by_outline.differences)
    assert any("Gauss-Newton" in each for each in by_outline.differences)
    (vertices,) = (each for each in by_outline.differences if "vertices, and" in each)
    for gender in Gender:
        prepared = prepared_model(gender)
        whole, searched = (
            len(each.model.mean_vertices) for each in (prepared.operators, prepared.searched)
        )
        shaded = len(prepared.searched.shaded.vertices)
        for count in (whole, round(searched, -2), round(shaded, -2)):
            assert f"{count:,}" in vertices


def test_the_simplex_lowers_the_same_energy(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("fitter.fits.paper._MOST_ENERGIES", dict.fromkeys(OptimizerKind, 300))
    request = asked(Paper())
    result = fit(
        replace(request, choices=replace(request.choices, optimizer=OptimizerKind.SIMPLEX))
    )
    assert sum(result.energies.values()) < sum(result.stages[0].energies.values())
    assert set(result.energies) == {each.value for each in E1}
    assert result.found.outcome.value == "evaluation_limit"
    assert any("60,000" in each for each in result.differences)


def test_a_fit_of_no_term_is_refused():
    with pytest.raises(InvalidInputError) as refused:
        fit(asked(Paper(energies=frozenset({PaperEnergy.SHADING}))))
    assert refused.value.field == "paper.energies"


def test_several_pictures_are_refused():
    with pytest.raises(InvalidInputError) as refused:
        fit(together(asked(Paper()), asked(Paper())))
    assert refused.value.field == "paper"
