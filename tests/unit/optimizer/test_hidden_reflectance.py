import numpy as np

from fitter.optimizer.hidden_reflectance import filled_in

EDGES = np.array([[k, k + 1] for k in range(5)])
LENGTHS = np.array([1.0, 1.0, 2.0, 1.0, 1.0])


def test_between_two_known_values_the_unknown_run_evenly_with_the_distance():
    known = np.array([True, True, False, False, True, True])
    values = np.array([0.2, 0.2, 9.0, 9.0, 0.6, 0.6])
    (found,) = filled_in([values], known, EDGES, LENGTHS)
    np.testing.assert_allclose(found, [0.2, 0.2, 0.3, 0.5, 0.6, 0.6], atol=1e-5)


def test_beyond_the_last_known_value_it_goes_on_unchanged():
    known = np.array([True, True, True, False, False, False])
    (found,) = filled_in([np.array([0.1, 0.4, 0.3, 9.0, 9.0, 9.0])], known, EDGES, LENGTHS)
    np.testing.assert_allclose(found[3:], 0.3, atol=1e-4)


def test_what_touches_nothing_known_takes_the_mean():
    known = np.array([True, True, False, False])
    values = np.array([0.2, 0.4, 9.0, 9.0])
    (found,) = filled_in([values], known, np.array([[0, 1], [2, 3]]), np.ones(2))
    np.testing.assert_allclose(found[2:], 0.3)


def test_what_is_known_stays_and_nothing_unknown_changes_nothing():
    values = np.array([0.2, 0.4, 0.5, 0.1, 0.3, 0.6])
    (found,) = filled_in([values], np.ones(6, dtype=bool), EDGES, LENGTHS)
    np.testing.assert_array_equal(found, values)


def test_fields_are_filled_each_by_its_own():
    known = np.array([True, True, False, False, True, True])
    first = np.array([0.2, 0.2, 9.0, 9.0, 0.6, 0.6])
    together = filled_in([first, 2.0 * first], known, EDGES, LENGTHS)
    np.testing.assert_allclose(together[1], 2.0 * together[0])
