"""The figures that the packaged models' headers claim, made again from the files alone."""

import numpy as np
import pytest

from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.numerics.meshes import enclosed_volume
from fitter.training.report.header_figures import model_figures

# How far a figure may lie from what the header says: the rounding of single precision, with room
# for another processor's, and far below what would matter.
TOLERANCES = {
    "vertices": 0,
    "triangles": 0,
    "shape_axes": 0,
    "height_mm": 0.05,
    "extent_mm": 0.05,
    "height_per_deviation_mm": 0.02,
    "height_change_at_3_deviations_mm": 0.02,
    "extent_change_at_3_deviations_mm": 0.05,
    "volume_l": 0.005,
    "weight_kg": 0.005,
    "surface_m2": 0.0005,
}
GREATEST_HEIGHT_CHANGE_MM = 1.0


@pytest.fixture(scope="module", params=["female", "male"])
def model(request):
    return load_body_model(packaged_model_path(request.param))


@pytest.fixture(scope="module")
def found(model):
    return model_figures(model)


def test_every_committed_figure_still_holds(model, found):
    claimed = model.header["model_figures"]
    assert set(claimed) == set(TOLERANCES)
    for name, tolerance in TOLERANCES.items():
        assert found[name] == pytest.approx(claimed[name], rel=0, abs=tolerance), name


def test_the_held_out_errors_agree_on_height(model, found):
    claimed = model.header["held_out_errors"]
    for name in (
        "height_change_at_3_deviations_mm",
        "extent_change_at_3_deviations_mm",
        "height_per_deviation_mm",
    ):
        assert found[name] == pytest.approx(claimed[name], rel=0, abs=TOLERANCES[name])
    height = model.header["height_m"]
    assert found["height_mm"] == pytest.approx(1000.0 * height["mean"], rel=0, abs=0.05)
    assert found["height_per_deviation_mm"] == pytest.approx(1000.0 * height["sd"], rel=0, abs=0.02)


def test_no_axis_but_the_first_changes_height(found):
    assert found["height_change_at_3_deviations_mm"] < GREATEST_HEIGHT_CHANGE_MM


def test_the_mean_body_is_a_person_of_the_training_subjects_size(model, found):
    stature, weight = model.header["stature_m"], model.header["model_weight_kg"]
    assert found["height_mm"] == pytest.approx(1000.0 * stature["mean"], rel=0, abs=5.0)
    # Volume curves upward in the shape, so that the mean body is lighter than the mean of bodies.
    assert weight["mean"] - 2.0 < found["weight_kg"] <= weight["mean"] + 0.1
    assert found["height_per_deviation_mm"] == pytest.approx(1000.0 * stature["sd"], rel=0.05)


def test_bodies_of_the_prior_weigh_what_the_training_subjects_weighed(model):
    """In pairs of opposite shapes, whose means leave only the curvature of volume to chance."""
    shapes = np.random.default_rng(0).normal(size=(60, len(model.shape_basis)))
    claimed = model.header["model_weight_kg"]
    pairs = np.array(
        [
            [
                1000.0 * enclosed_volume(rest_vertices(model, sign * shape), model.triangles)
                for sign in (1.0, -1.0)
            ]
            for shape in shapes
        ]
    )
    assert pairs.mean() == pytest.approx(claimed["mean"], abs=0.5)
    differences = 0.5 * (pairs[:, 0] - pairs[:, 1])
    spread = np.sqrt(np.mean(differences**2))
    # A spread of 60 draws is itself uncertain by a tenth.
    assert spread == pytest.approx(claimed["sd"], rel=0.25)
