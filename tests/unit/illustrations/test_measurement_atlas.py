"""The pictures of MEASUREMENTS.md show the tapes as they are now."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from fitter.vocabulary.measurements import Group
from tests.illustrations.measurements_page import ATLAS_FOLDER, TAPE, atlas_sheets, sheet_name

FOLDER = Path(__file__).parents[3] / ATLAS_FOLDER


@pytest.fixture(scope="module")
def sheets():
    return atlas_sheets()


def test_there_is_a_sheet_of_every_group(sheets):
    assert set(sheets) == set(Group)
    assert {path.name for path in FOLDER.iterdir()} == {sheet_name(group) for group in Group}


@pytest.mark.parametrize("group", list(Group))
def test_the_pictures_are_those_that_the_definitions_make(sheets, group):
    """But for what compression changes: it blurs red lines, and moves none."""
    stored = cv2.imread(str(FOLDER / sheet_name(group)))
    assert stored is not None
    drawn = sheets[group]
    assert stored.shape == drawn.shape
    difference = np.abs(stored[:, :, ::-1].astype(int) - drawn.astype(int))
    assert difference.mean() < 2.0
    red = (drawn == TAPE).all(axis=2)
    assert red.sum() > 200
    assert difference[red].mean() < 40.0


def test_all_pictures_together_are_small():
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < 600_000
