import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.training.report.repeatability_figures import repeatability_figures


@pytest.mark.parametrize("gender", ["female", "male"])
def test_measurements_repeat_within_a_millimetre(gender: str):
    model = load_body_model(packaged_model_path(gender))
    figures = repeatability_figures(model, np.random.default_rng(0), bodies=6)
    assert figures.moved.max() < 1e-6
    assert figures.noisy.max() < 0.1
    assert figures.noisy.min() > 0.0
    assert figures.mirrored.max() < 0.3
    assert len(figures.names) == len(figures.units) == len(figures.mirrored)
