"""The outline of loose clothes: closed forms, slopes, and what it asks of a body."""

from dataclasses import replace

import numpy as np
import pytest

from fitter.energies.edges import EdgeCostMap, edge_energy, edge_rows
from fitter.energies.rows import boundary_loss, boundary_weights
from fitter.energies.scales import scales_at
from fitter.energies.silhouette import (
    beyond_usual,
    bound_share,
    common_offset,
    ease_loss,
    ease_weights,
    silhouette_energy,
    silhouette_overlap,
    silhouette_rows,
)
from fitter.evidence.silhouette_evidence import SilhouetteEvidence, silhouette_evidence
from tests.unit.energies.test_terms import CAMERA, SCALES, box, rendered

WIDTH, HEIGHT = 60, 120
NEAR = scales_at(CAMERA, 3.0, boundary_eta_m=0.02)


def dressed(cloth: float) -> SilhouetteEvidence:
    """A box as it is seen, all of it cloth with some probability."""
    mask = rendered(WIDTH, HEIGHT)[0].silhouette
    return silhouette_evidence(mask, cloth=np.full(mask.shape, cloth, dtype=np.float32))


LARGE = (200, 300)
"""Pixels of a box that reaches farther than any clothes do."""


def within_large(cloth: float) -> SilhouetteEvidence:
    mask = rendered(*LARGE)[0].silhouette
    return silhouette_evidence(mask, cloth=np.full(mask.shape, cloth, dtype=np.float32))


def cost(residuals: np.ndarray, cloth: np.ndarray) -> np.ndarray:
    """The energy of a pixel of outline, as its module's docstring has it."""
    nats = 1.0 / (NEAR.silhouette_sigma**2 * NEAR.correlation_length)
    tight = boundary_loss(residuals, NEAR.silhouette_eta) * nats
    return bound_share(residuals, cloth) * tight + cloth * ease_loss(residuals, NEAR)


@pytest.mark.parametrize("cloth", [0.0, 0.4, 1.0])
def test_the_two_rows_of_a_pixel_of_outline_are_the_slope_of_its_cost(cloth):
    residuals = np.linspace(-20.0, 8.0, 57) + 0.01
    share = np.full(len(residuals), cloth)
    nats = 1.0 / (NEAR.silhouette_sigma**2 * NEAR.correlation_length)
    bound = bound_share(residuals, share) * boundary_weights(residuals, NEAR.silhouette_eta) * nats
    slope = bound * residuals + cloth * ease_weights(residuals, NEAR) * (residuals + NEAR.ease_mean)
    step = 1e-6
    expected = (cost(residuals + step, share) - cost(residuals - step, share)) / (2.0 * step)
    np.testing.assert_allclose(slope, expected, rtol=1e-6, atol=1e-9)


def test_without_cloth_the_cost_is_that_of_a_tight_outline():
    evidence, tight = dressed(0.0), dressed(0.0)
    tight = replace(tight, cloth=None)
    for shift in (0.0, 2.0, 30.0):
        seen = rendered(WIDTH, HEIGHT, shift)[0]
        expected = silhouette_energy(seen, tight, SCALES)
        assert silhouette_energy(seen, evidence, SCALES) == pytest.approx(expected, rel=1e-6)
        overlaps = [silhouette_overlap(seen, each, SCALES) for each in (evidence, tight)]
        assert overlaps[0] == pytest.approx(overlaps[1])


@pytest.mark.parametrize("inside", [2.0, 4.0, 6.0])
def test_a_body_within_its_clothes_costs_their_ease(inside):
    seen = rendered(WIDTH - 2 * inside, HEIGHT)[0]
    added = ease_loss(np.array([-inside]), NEAR) - ease_loss(np.array([0.0]), NEAR)
    expected = 2.0 * HEIGHT * float(added[0])
    found = silhouette_energy(seen, dressed(1.0), NEAR)
    assert found == pytest.approx(expected, rel=0.05, abs=0.05)


def test_a_body_outside_its_clothes_costs_as_much_as_outside_a_tight_outline():
    seen = rendered(WIDTH + 8, HEIGHT)[0]
    tight = silhouette_energy(seen, replace(dressed(1.0), cloth=None), NEAR)
    ease = (
        2.0 * HEIGHT * float(ease_loss(np.array([4.0]), NEAR)[0] - ease_loss(np.zeros(1), NEAR)[0])
    )
    clothed = silhouette_energy(seen, dressed(1.0), NEAR)
    assert clothed > tight
    assert clothed - tight == pytest.approx(ease, rel=0.35)


def test_clothes_cost_least_about_their_usual_ease():
    usual = NEAR.ease_mean
    at = {
        inside: silhouette_energy(rendered(WIDTH - 2 * inside, HEIGHT)[0], dressed(1.0), NEAR)
        for inside in (0.0, usual, 4.0 * usual)
    }
    assert min(at, key=at.__getitem__) == usual


def test_a_body_that_has_left_its_clothes_is_not_the_cheaper_for_it():
    costs = [
        silhouette_energy(rendered(size * WIDTH, size * HEIGHT)[0], dressed(1.0), NEAR)
        for size in (0.6, 0.4, 0.2)
    ]
    assert costs == sorted(costs)


@pytest.mark.parametrize(("inside", "outward"), [(0.0, False), (-4.0, False), (12.0, True)])
def test_rows_push_a_body_toward_the_usual_ease(inside, outward):
    seen, edges = rendered(WIDTH - 2 * inside, HEIGHT)
    wider = np.sign(seen.vertices[:, 0])
    push = 0.0
    for rows in silhouette_rows(seen, edges, dressed(1.0), NEAR):
        force = -(rows.weights * rows.residuals)[:, None] * rows.derivatives[..., 0]
        push += float((force * wider[rows.points]).sum())
    assert (push > 0.0) is outward


def test_the_overlap_does_not_count_what_clothes_add():
    seen = rendered(WIDTH - 20, HEIGHT)[0]
    assert silhouette_overlap(seen, dressed(1.0), NEAR) == pytest.approx(1.0, abs=0.01)
    assert silhouette_overlap(seen, dressed(0.0), NEAR) < 0.7


def test_the_overlap_counts_clothes_that_no_body_fills():
    lost = rendered(0.2 * LARGE[0], 0.2 * LARGE[1])[0]
    assert silhouette_overlap(lost, within_large(1.0), NEAR) < 0.5
    assert silhouette_overlap(rendered(*LARGE)[0], within_large(1.0), NEAR) == 1.0


class TestEdges:
    @pytest.fixture
    def scene(self):
        ramp = np.tile(np.linspace(0.1, 0.9, CAMERA.width, dtype=np.float32), (CAMERA.height, 1))
        return *rendered(WIDTH, HEIGHT), EdgeCostMap(cost=ramp)

    def test_edges_under_clothes_cost_nothing_and_pull_at_nothing(self, scene):
        rendering, edges, ramp = scene
        hidden = np.zeros(8)
        assert edge_energy(edges, ramp, NEAR, hidden) == 0.0
        assert not edge_rows(rendering, edges, ramp, NEAR, hidden).weights.any()

    def test_bare_edges_cost_as_if_clothes_were_tight(self, scene):
        rendering, edges, ramp = scene
        bare = np.ones(8)
        assert edge_energy(edges, ramp, NEAR, bare) == edge_energy(edges, ramp, NEAR)
        rows, plain = (edge_rows(rendering, edges, ramp, NEAR, b) for b in (bare, None))
        np.testing.assert_array_equal(rows.weights, plain.weights)

    def test_half_bare_vertices_cost_half_of_their_share(self, scene):
        _, edges, ramp = scene
        left = (box(WIDTH, HEIGHT)[0][:, 0] < 0.0).astype(float)
        both = [edge_energy(edges, ramp, NEAR, part) for part in (left, 1.0 - left)]
        assert sum(both) == pytest.approx(edge_energy(edges, ramp, NEAR))


class TestCommonOffset:
    LENGTHS = np.full(400, 2.0)
    EVEN = np.tile([1.0, 0.0], (400, 1))

    def test_it_is_the_most_probable_one(self):
        residuals = np.random.default_rng(0).normal(-1.8 * NEAR.ease_mean, 1.0, 400)

        def energy(offset: float) -> float:
            prior = 0.5 * (offset / NEAR.ease_common_spread) ** 2
            return float(self.LENGTHS @ ease_loss(residuals + offset, NEAR)) + prior

        found, none = common_offset(residuals, self.EVEN, self.LENGTHS, NEAR)
        assert found > 0.5 * NEAR.ease_mean
        assert none == 0.0
        for step in (-0.05, 0.05):
            assert energy(found) < energy(found + step)

    def test_clothes_as_usual_have_none(self):
        usual = np.full(400, -NEAR.ease_mean)
        assert not common_offset(usual, self.EVEN, self.LENGTHS, NEAR).any()

    def test_what_hardly_shows_cloth_says_little(self):
        residuals = np.full(400, -1.8 * NEAR.ease_mean)
        little, _ = common_offset(residuals, self.EVEN, 1e-6 * self.LENGTHS, NEAR)
        assert 0.0 < little < 0.01 * common_offset(residuals, self.EVEN, self.LENGTHS, NEAR)[0]

    def test_wide_trousers_say_nothing_of_a_shirt(self):
        fullness = np.repeat([[0.8, 0.0], [0.0, 1.6]], 200, axis=0)
        usual = -NEAR.ease_mean * fullness.sum(axis=1)
        residuals = usual - np.repeat([0.0, 3.0], 200)
        shifted = beyond_usual(residuals, fullness, NEAR)
        shirt, trousers = common_offset(shifted, fullness, self.LENGTHS, NEAR)
        assert abs(shirt) < 1e-9
        assert trousers == pytest.approx(3.0 / 1.6, rel=0.1)
