import numpy as np

from fitter.segmentation.grabcut import WEIGHT, preference, segment
from fitter.segmentation.trimap import trimap
from tests.unit.segmentation.test_grabcut import NO_BONES, figure, overlap, picture


def test_an_even_chance_says_nothing_and_a_certainty_is_bounded():
    seed = np.full((40, 30), 0.5, dtype=np.float32)
    seed[:, 10:20], seed[:, 20:] = 0.9, 1.0
    nats = preference(seed, None)
    np.testing.assert_allclose(nats[:, :10], 0.0, atol=1e-5)
    np.testing.assert_allclose(nats[:, 10:20], WEIGHT * np.log(9.0), rtol=1e-5)
    np.testing.assert_allclose(nats[:, 20:], WEIGHT * np.log(49.0), rtol=1e-4)


def test_the_mirror_image_of_a_chance_prefers_the_other_side():
    seed = np.linspace(0.0, 1.0, 40 * 30).reshape(40, 30)
    np.testing.assert_allclose(preference(seed, None), -preference(1.0 - seed, None), atol=1e-9)


def test_a_body_adds_its_inside_and_takes_its_outside():
    body = np.zeros((200, 150), dtype=np.bool_)
    body[20:180, 50:100] = True
    even = np.full(body.shape, 0.5, dtype=np.float32)
    nats = preference(even, body)
    assert nats[100, 75] > 20.0
    assert nats[100, 10] < -20.0
    np.testing.assert_allclose(nats[100, 49] + nats[100, 50], 0.0, atol=1e-3)
    np.testing.assert_allclose(preference(even, np.zeros_like(body)), nats.min(), rtol=1e-5)


def test_a_shaded_leg_of_the_walls_colour_is_kept_where_the_person_is_known_to_be():
    truth = figure()
    leg = truth & (np.arange(truth.shape[1]) < 140) & (np.arange(truth.shape[0])[:, None] > 260)
    shown = np.where(leg[..., None], picture(np.zeros_like(truth)), picture(truth))
    labels = trimap(figure(dx=2), NO_BONES, band=12)
    by_colour = segment(shown, labels).mask
    likely = np.where(truth, 0.9, 0.1).astype(np.float32)
    told = segment(shown, labels, preference(likely, None)).mask
    assert by_colour[leg].mean() < 0.5
    assert told[leg].mean() > 0.95
    assert overlap(told, truth) > overlap(by_colour, truth)
