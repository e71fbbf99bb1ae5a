"""Distances, outlines, edge costs and intensities of made-up pictures."""

import numpy as np
import pytest

from fitter.evidence.edge_cost import edge_cost_map
from fitter.evidence.intensity import intensity_map
from fitter.evidence.sampling import sample
from fitter.evidence.silhouette_evidence import silhouette_evidence

HEIGHT, WIDTH = 120, 160
CENTRE, RADIUS = np.array([80.0, 60.0]), 40.0


@pytest.fixture(scope="module")
def pixel_centres() -> np.ndarray:
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    return np.stack([x, y], axis=-1)


@pytest.fixture(scope="module")
def disc(pixel_centres) -> np.ndarray:
    return np.linalg.norm(pixel_centres - CENTRE, axis=-1) < RADIUS


def test_the_signed_distance_of_a_disc_is_the_distance_to_its_circle(disc, pixel_centres):
    evidence = silhouette_evidence(disc)
    exact = np.linalg.norm(pixel_centres - CENTRE, axis=-1) - RADIUS
    near = np.abs(exact) < 30
    assert np.abs(evidence.signed_distance - exact)[near].max() < 0.8
    assert np.abs((evidence.signed_distance - exact)[near].mean()) < 0.1


def test_outline_points_lie_on_the_circle_and_their_normals_point_out_of_it(disc):
    evidence = silhouette_evidence(disc)
    radial = evidence.boundary_points - CENTRE
    assert np.abs(np.linalg.norm(radial, axis=1) - RADIUS).max() < 0.9
    radial /= np.linalg.norm(radial, axis=1, keepdims=True)
    assert (np.einsum("ki,ki->k", radial, evidence.boundary_normals) > 0.95).all()
    assert len(radial) * evidence.boundary_spacing == pytest.approx(2 * np.pi * RADIUS, rel=0.15)


def test_the_normal_of_a_hole_points_into_the_hole(disc, pixel_centres):
    ring = disc & (np.linalg.norm(pixel_centres - CENTRE, axis=-1) > 20)
    evidence = silhouette_evidence(ring)
    radial = evidence.boundary_points - CENTRE
    inner = np.linalg.norm(radial, axis=1) < 30
    assert inner.sum() > 10
    assert (np.einsum("ki,ki->k", radial, evidence.boundary_normals)[inner] < 0).all()


def test_the_border_of_the_picture_is_no_outline():
    mask = np.zeros((60, 60), dtype=bool)
    mask[:30] = True
    evidence = silhouette_evidence(mask)
    assert (np.abs(evidence.boundary_points[:, 1] - 30.0) < 0.6).all()


def test_edge_cost_is_zero_on_a_step_and_one_far_from_it():
    picture = np.zeros((60, 80, 3), dtype=np.float32)
    picture[:, 40:] = 0.7
    cost = edge_cost_map(picture, threshold_px=8.0)
    on_step, near, far = cost.at(np.array([[40.0, 30.0], [44.0, 30.0], [70.0, 30.0]]))
    assert on_step < 0.15
    assert near == pytest.approx(0.5, abs=0.15)
    assert far == 1.0


def test_sampling_reproduces_a_bilinear_map_with_its_slopes(pixel_centres):
    plane = (2.0 * pixel_centres[..., 0] - 3.0 * pixel_centres[..., 1]).astype(np.float32)
    points = np.array([[10.3, 20.7], [55.5, 90.1]])
    values, slopes = sample(plane, points)
    np.testing.assert_allclose(values, 2 * points[:, 0] - 3 * points[:, 1], rtol=1e-5)
    np.testing.assert_allclose(slopes, [[2.0, -3.0]] * 2, atol=1e-3)


def test_the_background_never_bleeds_into_the_persons_luminance(disc):
    luminance = np.where(disc, 0.3, 1.0).astype(np.float32)
    display = np.repeat(np.where(disc, 0.58, 1.0)[..., None], 3, axis=2).astype(np.float32)
    intensity = intensity_map(luminance, display, disc)
    np.testing.assert_allclose(intensity.luminance[disc], 0.3, atol=1e-5)
    assert intensity.trusted[60, 80]
    assert not intensity.trusted[60, int(80 + RADIUS) - 1]
    assert not intensity.trusted[2, 2]
