import numpy as np
import pytest

from fitter.body.model import regress
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import DefinitionError
from fitter.measurement.definitions import JOINT_PREFIX, load_definitions, points_of
from fitter.measurement.skin_points import SkinPoint, load_skin_points, skin_rows
from tests.unit.measurement.solids import tube


def place(*, direction, level=None, origin=("middle",)):
    return SkinPoint(
        name="skin:place", meaning="Here.", origin=origin, level=level, direction=direction
    )


KNOWN = {"middle": np.array([0.0, 0.5, 0.0]), "low": np.array([7.0, 0.1, 7.0])}


@pytest.fixture
def cylinder():
    return tube(radius=0.2, height=1.0)


def test_a_place_lies_where_the_ray_leaves_the_skin(cylinder):
    rows = skin_rows([place(direction=(0.0, 0.0, -3.0))], KNOWN, *cylinder)
    (point,) = regress(rows, cylinder[0])
    assert point == pytest.approx([0.0, 0.5, -0.2], abs=1e-3)
    assert rows.weights.sum() == pytest.approx(1.0)
    assert (rows.weights >= -1e-9).all()


def test_a_ray_may_start_at_another_height(cylinder):
    found = skin_rows([place(direction=(1.0, 0.0, 0.0), level=("low",))], KNOWN, *cylinder)
    assert regress(found, cylinder[0])[0] == pytest.approx([0.2, 0.1, 0.0], abs=1e-3)


def test_a_ray_starts_amid_its_points(cylinder):
    known = {**KNOWN, "other": np.array([0.1, 0.3, 0.0])}
    found = skin_rows(
        [place(direction=(0.0, 0.0, 1.0), origin=("middle", "other"))], known, *cylinder
    )
    assert regress(found, cylinder[0])[0, :2] == pytest.approx([0.05, 0.4], abs=1e-9)


def test_a_place_moves_with_the_skin_around_it(cylinder):
    vertices, triangles = cylinder
    rows = skin_rows([place(direction=(0.3, 0.1, 1.0))], KNOWN, vertices, triangles)
    before, after = regress(rows, vertices), regress(rows, vertices * [2.0, 1.0, 3.0] + 1.0)
    assert after == pytest.approx(before * [2.0, 1.0, 3.0] + 1.0)


def test_a_ray_that_meets_no_skin_is_an_error_that_names_the_place(cylinder):
    known = {"middle": np.array([9.0, 0.5, 0.0])}
    with pytest.raises(DefinitionError, match="skin:place: the ray from middle meets no skin"):
        skin_rows([place(direction=(1.0, 0.0, 0.0))], known, *cylinder)


@pytest.mark.parametrize("gender", ["female", "male"])
def test_every_place_stands_on_landmarks_that_the_models_have(gender):
    model = load_body_model(packaged_model_path(gender))
    known = {*model.landmarks.names, *(JOINT_PREFIX + part for part in model.part_names)}
    for point in load_skin_points().values():
        assert set(point.needs) <= known, point.name
        assert point.meaning.endswith(".")


def test_every_place_is_used():
    used = {name for definition in load_definitions() for name in points_of(definition)}
    assert set(load_skin_points()) <= used
