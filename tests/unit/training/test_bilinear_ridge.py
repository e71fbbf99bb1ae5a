import numpy as np

from fitter.training.articulation.bilinear_ridge import BilinearSums, solve_bilinear

RNG = np.random.default_rng(12)
FEATURES, SHAPES, OUTPUTS = 4, 3, 6
ALIKE = np.eye(OUTPUTS // 3)


def examples(count: int, strengths: np.ndarray, linear: np.ndarray):
    for _ in range(count):
        x, shape = RNG.normal(size=FEATURES), RNG.normal(size=SHAPES)
        yield x, shape, ((1.0 + strengths @ shape) * x) @ linear


def solved(count: int, strengths: np.ndarray, linear: np.ndarray, ridge: float = 1e-12):
    sums = BilinearSums(feature_count=FEATURES, shape_count=SHAPES, output_count=OUTPUTS)
    for x, shape, output in examples(count, strengths, linear):
        sums.add(x, shape, output)
    return solve_bilinear(sums, ridge, ALIKE)


def test_a_planted_bilinear_law_is_recovered():
    strengths = 0.2 * RNG.normal(size=(FEATURES, SHAPES))
    linear = RNG.normal(size=(FEATURES, OUTPUTS))
    found = solved(500, strengths, linear)
    np.testing.assert_allclose(found.linear, linear, rtol=0.02, atol=0.01)
    np.testing.assert_allclose(found.strengths, strengths, rtol=0.05, atol=0.01)


def test_a_linear_law_needs_no_strengths():
    linear = RNG.normal(size=(FEATURES, OUTPUTS))
    found = solved(200, np.zeros((FEATURES, SHAPES)), linear)
    np.testing.assert_allclose(found.linear, linear, atol=1e-8)
    np.testing.assert_allclose(found.strengths, 0.0, atol=1e-8)


def test_a_feature_that_never_occurs_learns_nothing():
    sums = BilinearSums(feature_count=2, shape_count=1, output_count=3)
    for _ in range(50):
        sums.add(np.array([RNG.normal(), 0.0]), RNG.normal(size=1), RNG.normal(size=3))
    np.testing.assert_array_equal(solve_bilinear(sums, 1e-3, np.eye(1)).linear[1], 0.0)


def test_no_examples_give_no_term():
    sums = BilinearSums(feature_count=2, shape_count=1, output_count=3)
    found = solve_bilinear(sums, 1e-3, np.eye(1))
    assert not found.linear.any()
    assert not found.strengths.any()


def test_a_stronger_ridge_gives_a_smaller_answer():
    linear = RNG.normal(size=(FEATURES, OUTPUTS))
    weak, strong = (
        np.linalg.norm(solved(100, np.zeros((FEATURES, SHAPES)), linear, ridge).linear)
        for ridge in (1e-6, 10.0)
    )
    assert strong < 0.5 * weak
