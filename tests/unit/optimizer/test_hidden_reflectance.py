import numpy as np

from fitter.optimizer.hidden_reflectance import HiddenVertices

EDGES = np.array([[k, k + 1] for k in range(5)])
LENGTHS = np.array([1.0, 1.0, 2.0, 1.0, 1.0])


def test_between_two_known_values_the_unknown_run_evenly_with_the_distance():
    known = np.array([True, True, False, False, True, True])
    values = np.array([0.2, 0.2, 9.0, 9.0, 0.6, 0.6])
    found = HiddenVertices.of(known, EDGES, LENGTHS).filled(values)
    np.testing.assert_allclose(found, [0.2, 0.2, 0.3, 0.5, 0.6, 0.6], atol=1e-5)


def test_beyond_the_last_known_value_it_goes_on_unchanged():
    known = np.array([True, True, True, False, False, False])
    values = np.array([0.1, 0.4, 0.3, 9.0, 9.0, 9.0])
    found = HiddenVertices.of(known, EDGES, LENGTHS).filled(values)
    np.testing.assert_allclose(found[3:], 0.3, atol=1e-4)


def test_what_touches_nothing_known_takes_the_mean():
    known = np.array([True, True, False, False])
    values = np.array([0.2, 0.4, 9.0, 9.0])
    pairs = np.array([[0, 1], [2, 3]])
    found = HiddenVertices.of(known, pairs, np.ones(2)).filled(values)
    np.testing.assert_allclose(found[2:], 0.3)


def test_what_is_known_stays_and_nothing_unknown_changes_nothing():
    values = np.array([0.2, 0.4, 0.5, 0.1, 0.3, 0.6])
    found = HiddenVertices.of(np.ones(6, dtype=bool), EDGES, LENGTHS).filled(values)
    np.testing.assert_array_equal(found, values)


def test_one_factorisation_serves_every_field():
    known = np.array([True, True, False, False, True, True])
    first = np.array([0.2, 0.2, 9.0, 9.0, 0.6, 0.6])
    hidden = HiddenVertices.of(known, EDGES, LENGTHS)
    np.testing.assert_allclose(hidden.filled(2.0 * first), 2.0 * hidden.filled(first))
