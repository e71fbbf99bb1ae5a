import numpy as np
import pytest

from fitter.segmentation.colour_mixture import ColourMixture, first_mixture
from fitter.segmentation.grabcut import BandGraph
from fitter.segmentation.trimap import TrimapLabel, is_uncertain
from tests.unit.segmentation.plain_grabcut import border_cost, opencv_cut, plain_costs
from tests.unit.segmentation.rendered_pictures import PICTURES, rendered_picture


def picture_and_labels(name: str) -> tuple[np.ndarray, np.ndarray]:
    picture = rendered_picture(name)
    return picture.pixels, picture.labels


def mixtures(picture: np.ndarray, labels: np.ndarray) -> tuple[ColourMixture, ColourMixture]:
    sides = (labels == TrimapLabel.BACKGROUND, labels == TrimapLabel.FOREGROUND)
    background, foreground = (first_mixture(picture[side].astype(np.float32)) for side in sides)
    return background, foreground


def cut(
    picture: np.ndarray, labels: np.ndarray, sides: tuple[ColourMixture, ColourMixture]
) -> np.ndarray:
    band, mask = is_uncertain(labels), labels == TrimapLabel.FOREGROUND
    colours = picture[band].astype(np.float32)
    graph = BandGraph.of(picture, band, mask)
    mask[band] = graph.cut(sides[0].costs(colours) - sides[1].costs(colours))
    return mask


def energy(
    picture: np.ndarray,
    labels: np.ndarray,
    mask: np.ndarray,
    sides: tuple[ColourMixture, ColourMixture],
) -> float:
    """E of Rother et al., equation 2, of a mask, nats; known pixels' colours left out."""
    band = is_uncertain(labels)
    colours = picture[band].astype(np.float64)
    own = np.where(mask[band], plain_costs(sides[1], colours), plain_costs(sides[0], colours))
    return float(own.sum()) + border_cost(picture, mask)


@pytest.mark.parametrize("name", PICTURES)
def test_the_cut_of_the_band_costs_what_opencvs_of_the_whole_picture_costs(name: str):
    picture, labels = picture_and_labels(name)
    sides = mixtures(picture, labels)
    assert all(len(side.weights) == 5 for side in sides)
    ours, theirs = cut(picture, labels, sides), opencv_cut(picture, labels, *sides)
    costs = [energy(picture, labels, mask, sides) for mask in (ours, theirs)]
    # Capacities are rounded to thousandths of a nat.
    assert costs[0] == pytest.approx(costs[1], abs=1.0, rel=1e-6)
    assert (ours != theirs).sum() < 1e-3 * is_uncertain(labels).sum()


def test_no_single_pixel_can_be_moved_to_the_other_side_at_less_cost():
    random = np.random.default_rng(3)
    picture = random.integers(0, 256, (9, 8, 3)).astype(np.uint8)
    labels = np.full((9, 8), TrimapLabel.LIKELY_FOREGROUND, dtype=np.uint8)
    labels[:2], labels[-2:] = TrimapLabel.BACKGROUND, TrimapLabel.FOREGROUND
    sides = tuple(
        ColourMixture(
            weights=np.ones(1), means=np.array([[mean] * 3]), covariances=4e3 * np.eye(3)[None]
        )
        for mean in (90.0, 160.0)
    )
    background, foreground = sides
    mask = cut(picture, labels, (background, foreground))
    least = energy(picture, labels, mask, (background, foreground))
    assert 0 < mask[2:-2].sum() < mask[2:-2].size
    for i, j in np.argwhere(is_uncertain(labels)):
        other = mask.copy()
        other[i, j] = not other[i, j]
        assert energy(picture, labels, other, (background, foreground)) > least - 0.1


def test_a_second_cut_of_a_graph_is_that_of_a_new_one():
    picture, labels = picture_and_labels(PICTURES[0])
    band, known = is_uncertain(labels), labels == TrimapLabel.FOREGROUND
    random = np.random.default_rng(0)
    first, second = random.normal(scale=20.0, size=(2, band.sum()))
    used = BandGraph.of(picture, band, known)
    used.cut(first)
    np.testing.assert_array_equal(used.cut(second), BandGraph.of(picture, band, known).cut(second))


def test_a_picture_of_one_colour_is_cut_by_preference_and_length_alone():
    picture = np.full((20, 20, 3), 77, dtype=np.uint8)
    band = np.zeros((20, 20), dtype=np.bool_)
    band[5:15, 5:15] = True
    known = np.zeros_like(band)
    known[:, :5] = True
    graph = BandGraph.of(picture, band, known)
    assert not graph.cut(np.full(100, -1e6)).any()
    assert graph.cut(np.full(100, 1e6)).all()
