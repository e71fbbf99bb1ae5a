import numpy as np
import pytest

from fitter.training.report.shape_curve import error_by_count, error_by_metric, region_errors
from fitter.training.shapes.surface import vertex_areas
from tests.unit.training.synthetic_population import MEAN, TRIANGLES, population

TRAINING, HELD_OUT = population(60, 1).rest, population(12, 2).rest
UPPER = MEAN[:, 1] > 0.0
REGIONS = {"upper": UPPER, "lower": ~UPPER, "none": np.zeros(len(MEAN), dtype=bool)}


def test_the_error_falls_with_the_number_of_axes_and_ends_where_bodies_were_planted():
    curve = error_by_count(TRAINING, HELD_OUT, TRIANGLES)
    assert list(curve) == ["5", "10", "20", "40"]
    errors = [curve[count]["by_vertex"] for count in curve]
    assert errors[0] > errors[1] > 1.0
    assert errors[2] < 0.01
    assert errors[3] < 0.01


def test_a_metric_serves_what_it_weighs():
    # With fewer training bodies than planted axes no metric can be exact.
    by_metric = error_by_metric(TRAINING[:12], HELD_OUT, TRIANGLES, REGIONS)
    assert set(by_metric) == {"area", "model", "vertex"}
    assert by_metric["vertex"]["by_vertex"] <= by_metric["area"]["by_vertex"]
    assert by_metric["area"]["by_area"] <= by_metric["vertex"]["by_area"]


def test_region_errors_are_means_over_each_regions_skin():
    areas = vertex_areas(MEAN, TRIANGLES)
    residuals = np.zeros((1, *MEAN.shape))
    residuals[0, UPPER, 0] = 0.002
    share = areas[UPPER].sum() / areas.sum()
    found = region_errors(residuals, areas, REGIONS)
    # Centring moves the whole body by the mean.
    assert found["upper"] == pytest.approx(2.0 * (1.0 - share))
    assert found["lower"] == pytest.approx(2.0 * share)
    assert "none" not in found
