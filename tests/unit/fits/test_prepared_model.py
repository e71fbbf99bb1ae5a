"""A model with everything prepared, as it is made and as it is read again."""

import pickle

import numpy as np
import pytest

from fitter.body.storage import packaged_model_path
from fitter.fits.kept_models import VARIABLE, kept
from fitter.fits.prepared_model import PreparedModel, prepared_model
from fitter.vocabulary.choices import Gender


def parts(prepared: PreparedModel) -> tuple[bytes, list[memoryview]]:
    """Everything but the arrays, and the arrays that lie in one piece."""
    buffers: list[pickle.PickleBuffer] = []
    pickled = pickle.dumps(prepared, protocol=5, buffer_callback=buffers.append)
    return pickled, [buffer.raw() for buffer in buffers]


@pytest.mark.parametrize("gender", Gender)
def test_a_model_is_read_as_it_was_prepared(gender, tmp_path, monkeypatch):
    monkeypatch.setenv(VARIABLE, str(tmp_path))
    source = packaged_model_path(gender.value)
    prepared = prepared_model(gender)
    kept(source, lambda: prepared)
    read = kept(source, lambda: None)
    assert isinstance(read, PreparedModel)
    assert read is not prepared
    (others, arrays), (_, read_arrays) = parts(prepared), parts(read)
    assert [bytes(array) for array in read_arrays] == [bytes(array) for array in arrays]
    # One that were not in one piece would be read as one that is, and lead to other last digits.
    assert b"_reconstruct" not in others
    body = np.random.default_rng(5).normal(size=len(prepared.measuring.canonical.derivative))
    measure = prepared.population.shapes.measure
    np.testing.assert_array_equal(
        read.population.shapes.measure(body, [0, 3]), measure(body, [0, 3])
    )
