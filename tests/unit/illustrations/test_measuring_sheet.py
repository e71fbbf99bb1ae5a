"""The pictures of MEASURING.md and of the page show what the checks really say."""

import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from fitter.detection.detector import installed_detector
from fitter.vocabulary.remarks import Code
from tests.accuracy.cases import CASES
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Half
from tests.illustrations.measuring_sheet import (
    FOLDER,
    SHEET,
    SMALL_TILE_PX,
    TILES,
    WITHOUT_EXAMPLE,
    captions,
    examples,
    sheet,
    tiles,
)

REPOSITORY = Path(__file__).parents[3]
GUIDE = REPOSITORY / "MEASURING.md"
CAPTIONS = REPOSITORY / "service" / "page" / "src" / "messages" / "howto.ts"
HOW_TO = REPOSITORY / "service" / "page" / "src" / "start" / "HowTo.tsx"


@pytest.fixture(scope="module")
def shown():
    return examples()


@pytest.fixture(scope="module")
def said(shown):
    return captions(shown, installed_detector())


def test_the_checks_find_in_every_example_what_it_is_an_example_of(shown, said):
    meant = [[] if each.code is None else [each.code] for each in shown]
    assert said == meant


def test_there_is_an_example_of_every_code_but_of_those_that_are_left_out(shown):
    codes = [each.code for each in shown if each.code is not None]
    assert sorted(codes) == sorted(set(Code) - WITHOUT_EXAMPLE)
    assert sum(each.code is None for each in shown) >= 2


def test_nobody_of_the_reporting_half_is_shown():
    source = (REPOSITORY / "tests" / "illustrations" / "measuring_sheet.py").read_text()
    names = set(re.findall(r'"((?:phone_|clothed_)?(?:wo)?man_\w+)"', source))
    assert names
    assert {PEOPLE[CASES[name].person].half for name in names} == {Half.TUNING}


def test_the_stored_pictures_are_those_that_are_drawn(shown, said):
    for name, drawn in ((SHEET, sheet(shown, said)), (TILES, tiles(shown))):
        stored = cv2.imread(str(FOLDER / name))
        assert stored is not None
        assert stored.shape == drawn.shape
        difference = np.abs(stored[:, :, ::-1].astype(int) - drawn.astype(int))
        assert difference.mean() < 3.0
        assert (FOLDER / name).stat().st_size < 200_000


def test_the_page_names_the_same_examples_in_the_same_order(shown):
    source = HOW_TO.read_text()
    tiles = re.search(r"const GOOD = \[(.*?)\].*?const BAD = \[(.*?)\]", source, re.DOTALL)
    good, bad = (re.findall(r'"([\w-]+)"', names) for names in tiles.groups())
    captions = dict(re.findall(r'"?([\w-]+)"?: \{ what: "([^"]+)"', CAPTIONS.read_text()))
    named = [(None, captions[name]) for name in good] + [(code, captions[code]) for code in bad]
    assert named == [
        (each.code and each.code, each.title[0].lower() + each.title[1:]) for each in shown
    ]
    size = re.search(r"const WIDTH = (\d+);\nconst HEIGHT = (\d+);", source)
    assert size is not None
    assert (int(size[1]), int(size[2])) == SMALL_TILE_PX


def test_the_guide_shows_the_sheet_and_has_a_row_for_every_code():
    guide = GUIDE.read_text()
    assert f"](service/demo_data/{SHEET})" in guide
    rows = re.findall(r"^\| `([\w-]+)` \| ", guide, flags=re.MULTILINE)
    assert rows == [code.value for code in Code if code is not Code.CONTRADICTED]
