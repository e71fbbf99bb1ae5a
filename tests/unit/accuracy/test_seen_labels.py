import numpy as np
import pytest

from tests.accuracy.files import read_labels, write_labels
from tests.accuracy.scene import Label
from tests.accuracy.seen_labels import CLASSES, label_overlaps


def _labels(*rows: str) -> np.ndarray:
    return np.array([[int(each) for each in row] for row in rows], dtype=np.uint8)


def test_what_is_alike_overlaps_wholly_and_what_nobody_wears_is_left_out():
    true = _labels("0113", "2134")
    overlaps = label_overlaps(true, true)
    assert overlaps.pop("shoes") is None
    assert set(overlaps) == set(CLASSES) - {"shoes"}
    assert set(overlaps.values()) == {1.0}


def test_cloth_taken_for_skin_costs_both():
    overlaps = label_overlaps(_labels("1113"), _labels("1133"))
    assert overlaps["skin"] == pytest.approx(2 / 3)
    assert overlaps["cloth"] == overlaps["upper"] == pytest.approx(1 / 2)
    assert overlaps["person"] == 1.0


def test_hair_taken_for_skin_costs_both():
    overlaps = label_overlaps(_labels("0113"), _labels("2213"))
    assert overlaps["skin"] == pytest.approx(1 / 2)
    assert overlaps["hair"] == 0.0
    assert overlaps["person"] == pytest.approx(3 / 4)


def test_labels_are_read_as_they_were_written(tmp_path):
    labels = np.arange(6, dtype=np.uint8).reshape(2, 3)
    write_labels(tmp_path / "labels.png", labels)
    np.testing.assert_array_equal(read_labels(tmp_path / "labels.png"), labels)
    assert set(labels.ravel()) == set(Label)
