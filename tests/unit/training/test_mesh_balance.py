import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.report.mesh_balance import region_meshes
from fitter.training.report.refinement_effect import refinement_effect


@pytest.fixture(scope="module")
def model():
    return load_body_model(packaged_model_path("male"))


@pytest.fixture(scope="module")
def effect(model):
    return refinement_effect(model)


def test_regions_share_out_all_triangles_and_all_skin(model):
    regions = region_meshes(model).values()
    assert sum(region.triangle_share for region in regions) == pytest.approx(1.0)
    assert sum(region.area_share for region in regions) == pytest.approx(1.0)


def test_head_hands_and_feet_hold_most_triangles_on_little_skin(model):
    regions = region_meshes(model)
    fine = [regions[name] for name in ("head", "hands", "feet")]
    assert sum(region.triangle_share for region in fine) > 0.6
    assert sum(region.area_share for region in fine) < 0.2
    assert max(region.mean_edge_mm for region in fine) < regions["legs"].mean_edge_mm


def test_a_smooth_skin_is_a_little_wider_and_heavier_than_flat_triangles(effect):
    changes = np.array(list(effect.girths_cm.values()))
    assert 0.0 < changes.mean() < 0.3
    assert np.abs(changes).max() < 0.6
    assert 0.1 < effect.weight_kg < 1.5


def test_outline_and_shading_hardly_change(effect):
    assert 0.05 < effect.outline_mm < 1.0
    assert 0.0 < effect.shading < 0.05
