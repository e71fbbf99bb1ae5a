"""Drawn dressed people: repeatable, labelled, and as broad as real ones."""

import numpy as np
import pytest

from fitter.detection.worn_parts import WornPart
from fitter.training.dressed.bodies import standing_body
from fitter.training.dressed.garments import outer
from fitter.training.dressed.pictures import SIZE, dressed_picture
from fitter.training.dressed.samples import PIXELS, changed, chosen_pixels


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20261127)


def test_a_number_is_a_picture():
    one, same, other = (dressed_picture(seed) for seed in (3, 3, 4))
    assert np.array_equal(one.picture, same.picture)
    assert np.array_equal(one.labels, same.labels)
    assert not np.array_equal(one.labels, other.labels)


@pytest.mark.parametrize("seed", range(6))
def test_pictures_show_a_person_with_skin(seed: int):
    picture, labels = dressed_picture(seed)
    assert picture.shape == (SIZE, SIZE, 3)
    assert set(np.unique(labels)) <= set(WornPart)
    assert {WornPart.BACKGROUND, WornPart.SKIN} <= set(np.unique(labels))
    assert 0.03 < (labels > 0).mean() < 0.5


def test_an_outer_garment_stands_off(rng: np.random.Generator):
    broader = []
    for _ in range(12):
        body = standing_body(rng)
        trunk = body.vertices[~body.rest.on_arms]
        hung = outer(body, rng)[1].vertices
        heights = np.quantile(hung[:, 1], [0.3, 0.7])
        for low in heights:
            spans = [np.ptp(each[np.abs(each[:, 1] - low) < 0.03, 0]) for each in (trunk, hung)]
            broader.append(100.0 * (spans[1] - spans[0]))
    assert min(broader) > 0.0
    assert 4.0 < np.mean(broader) < 18.0


def test_what_is_changed_keeps_its_labels(rng: np.random.Generator):
    labels = np.zeros((SIZE, SIZE), np.uint8)
    labels[80:200, 100:160] = WornPart.CLOTH
    picture = np.full((SIZE, SIZE, 3), 30, np.uint8)
    picture[labels > 0] = 220
    drawn = dressed_picture(0)._replace(picture=picture, labels=labels)
    for _ in range(5):
        look = changed(drawn, rng)
        there = look.picture.mean(axis=2) > look.picture.mean()
        assert (there == (look.labels > 0)).mean() > 0.98


def test_every_part_that_is_there_is_sampled(rng: np.random.Generator):
    labels = dressed_picture(3).labels
    chosen, stands_for = chosen_pixels(labels, rng)
    assert set(np.unique(labels)) == set(np.unique(labels.ravel()[chosen]))
    assert 0.5 * PIXELS < len(chosen) <= PIXELS
    of_person = labels.ravel()[chosen] > 0
    assert stands_for[of_person].sum() == pytest.approx((labels > 0).sum(), rel=1e-4)
