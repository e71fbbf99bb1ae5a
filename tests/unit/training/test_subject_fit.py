from pathlib import Path

import numpy as np
import pytest

from fitter.numerics.meshes import enclosed_volume
from fitter.training.makehuman.body_space import average_traits, source_vertices
from fitter.training.people.population import (
    PACKAGED_PEOPLE,
    Workshop,
    load_population,
    population_path,
    prepare,
    save_population,
    solve_population,
)
from fitter.training.people.subject_fit import (
    Placed,
    Wanted,
    fit_subject,
    measured,
    place,
    volume_and_pull,
)
from fitter.training.surveys.cuts import limb_cut, trunk_cut
from fitter.training.surveys.survey_measurements import (
    MEASUREMENTS,
    LinearForms,
    place_measurements,
)
from tests.unit.measurement.solids import sphere
from tests.unit.training.makehuman_data import body_space, landmarks, needs_makehuman


def measured_lengths(forms: LinearForms, source: np.ndarray) -> np.ndarray:
    """Every measurement but weight, metres, one term at a time."""
    lengths = np.zeros(len(MEASUREMENTS) - 1)
    differences = forms.differences @ source
    for difference, axis, measurement in zip(
        differences, forms.axis, forms.measurement, strict=True
    ):
        lengths[measurement] += np.linalg.norm(difference) if axis < 0 else difference[axis]
    return lengths


@pytest.fixture(scope="module")
def workshop() -> Workshop:
    return prepare(body_space("female"), landmarks())


def placed_on(workshop: Workshop, parameters: np.ndarray) -> Placed:
    space = workshop.space
    body = source_vertices(space, average_traits(), parameters)
    forms = place_measurements(space.base, workshop.trunk, workshop.rows, body)
    return place(space, average_traits(), forms, workshop.body_targets)


def some_parameters(workshop: Workshop, seed: int) -> np.ndarray:
    space = workshop.space
    draw = np.random.default_rng(seed).uniform(-0.4, 0.4, len(space.neutral))
    return space.neutral + draw * np.where(space.neutral == 0.0, 1.0, 0.5)


def test_volume_has_the_derivative_that_finite_differences_give():
    vertices, triangles = sphere(radius=0.5, rings=8, sides=12)
    volume, gradient = volume_and_pull(vertices, triangles)
    assert volume == pytest.approx(enclosed_volume(vertices, triangles))
    direction = np.random.default_rng(0).normal(size=vertices.shape)
    step = 1e-5
    above, _ = volume_and_pull(vertices + step * direction, triangles)
    below, _ = volume_and_pull(vertices - step * direction, triangles)
    assert (gradient * direction).sum() == pytest.approx((above - below) / (2 * step), rel=1e-6)


@needs_makehuman
def test_measurements_by_target_are_those_of_the_body_itself(workshop: Workshop):
    parameters = some_parameters(workshop, 3)
    placed = placed_on(workshop, workshop.space.neutral)
    values, _ = measured(placed, parameters)
    body = source_vertices(workshop.space, average_traits(), parameters)
    np.testing.assert_allclose(values[:-1], measured_lengths(placed.forms, body), atol=1e-6)
    base = workshop.space.base
    volume = enclosed_volume(base.body(body), base.triangles)
    assert values[-1] == pytest.approx(1000.0 * volume, rel=1e-5)


@needs_makehuman
def test_measurements_have_the_derivatives_that_finite_differences_give(workshop: Workshop):
    parameters = some_parameters(workshop, 4)
    placed = placed_on(workshop, parameters)
    _, derivative = measured(placed, parameters)
    step = 1e-5
    # Of all parameters at once: each direction has its share of every column.
    for direction in np.random.default_rng(6).normal(size=(4, len(parameters))):
        above, _ = measured(placed, parameters + step * direction)
        below, _ = measured(placed, parameters - step * direction)
        np.testing.assert_allclose(
            derivative @ direction, (above - below) / (2 * step), rtol=1e-4, atol=1e-4
        )


@needs_makehuman
def test_a_bodys_own_measurements_are_found_again(workshop: Workshop):
    truth = some_parameters(workshop, 5)
    placed = placed_on(workshop, truth)
    measurements, _ = measured(placed, truth)
    deviation = workshop.statistics.deviation
    wanted = Wanted(
        measurements=measurements,
        tolerance=0.01 * deviation,
        centre=workshop.space.neutral,
        spread=np.full(len(truth), 0.4),
    )
    found = fit_subject(placed, wanted, workshop.space.neutral)
    reached, _ = measured(placed, found)
    assert np.abs((reached - measurements) / deviation).max() < 0.05
    assert (found >= workshop.space.lower).all()
    assert (found <= workshop.space.upper).all()


@pytest.mark.slow
@needs_makehuman
def test_a_population_begins_with_the_shorter_one_and_meets_its_measurements(workshop: Workshop):
    one = solve_population(workshop, 1, seed=11)
    two = solve_population(workshop, 2, seed=11)
    assert np.array_equal(one.source_vertices[0], two.source_vertices[0])
    assert not np.array_equal(two.source_vertices[0], two.source_vertices[1])
    stature = MEASUREMENTS.index("stature")
    assert np.abs(two.reached - two.wanted)[:, stature].max() < 0.015
    assert np.median(np.abs(two.reached - two.wanted) / workshop.statistics.deviation) < 0.05


@pytest.mark.slow
@needs_makehuman
def test_a_population_is_kept_without_its_vertices_and_comes_back_with_them(
    workshop: Workshop, tmp_path: Path
):
    solved = solve_population(workshop, 2, seed=11)
    save_population(tmp_path / "population.npz", solved)
    assert (tmp_path / "population.npz").stat().st_size < 20_000
    loaded = load_population(tmp_path / "population.npz", workshop.space)
    assert np.array_equal(loaded.source_vertices, solved.source_vertices)
    assert np.array_equal(loaded.reached, solved.reached)
    first = load_population(tmp_path / "population.npz", workshop.space, count=1)
    assert np.array_equal(first.source_vertices, solved.source_vertices[:1])
    with pytest.raises(ValueError, match="other parameters"):
        load_population(tmp_path / "population.npz", body_space("male"))


@needs_makehuman
@pytest.mark.parametrize("gender", ["female", "male"])
def test_the_packaged_population_is_of_every_build_and_keeps_off_its_bounds(gender: str):
    space = body_space(gender)
    population = load_population(population_path(PACKAGED_PEOPLE, gender, 1), space, count=3)
    with np.load(population_path(PACKAGED_PEOPLE, gender, 1), allow_pickle=False) as archive:
        parameters, wanted, reached = (
            archive[name] for name in ("parameters", "wanted", "reached")
        )
        ages = archive["ages"]
    assert len(parameters) == 1300
    at_bound = (parameters <= space.lower) | (parameters >= space.upper)
    assert at_bound.mean(axis=0).max() < 0.10
    stature, weight, waist = (
        MEASUREMENTS.index(name) for name in ("stature", "weightkg", "waistcircumference")
    )
    index = wanted[:, weight] / wanted[:, stature] ** 2
    assert 16.0 <= index.min() < 17.5
    assert 43.5 < index.max() <= 45.0
    assert ages.min() < 20.0
    assert ages.max() > 78.0
    error = np.abs(reached - wanted)
    assert error[:, stature].mean() < 0.0026
    assert error[:, weight].mean() < 1.0
    assert abs((reached - wanted)[:, waist].mean()) < 0.005
    # The first subject's body encloses the volume of the weight it reached.
    volume = enclosed_volume(
        space.base.body(population.source_vertices[0]).astype(np.float64), space.base.triangles
    )
    assert 1000.0 * volume == pytest.approx(reached[0, weight], abs=0.01)


@needs_makehuman
def test_the_chest_is_measured_without_the_arms_where_they_join_the_trunk(workshop: Workshop):
    space = workshop.space
    body = space.base.body(source_vertices(space, average_traits(), space.neutral))
    up = np.array([0.0, 1.0, 0.0])
    nipple = sum(
        weight * up @ body[space.base.body_vertex_ids.searchsorted(vertex)]
        for vertex, weight in workshop.rows["nipple"].items()
    )

    def girths(rise_m: float) -> tuple[float, float]:
        point = (nipple + rise_m) * up
        whole = limb_cut(body, space.base.triangles, point, up)
        return trunk_cut(body, workshop.trunk, point, up).girth(body), whole.girth(body)

    assert girths(0.03)[0] == girths(0.03)[1]
    # Two centimetres up is where the arms join in a level cut of the whole body.
    assert girths(0.05)[1] > girths(0.03)[1] + 0.3
    assert girths(0.05)[0] < girths(0.03)[0] + 0.1
