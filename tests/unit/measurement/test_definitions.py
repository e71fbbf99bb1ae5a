from pathlib import Path

import pytest

from fitter.fits.usable_model import NEEDED_PARTS
from fitter.measurement.definitions import (
    JOINT_PREFIX,
    Contour,
    Extent,
    Girth,
    Orientation,
    load_definitions,
    needed_points,
    parts_of,
)
from fitter.vocabulary.measurements import CHIEF, Group, group_of
from tests.illustrations.measurements_page import (
    described,
    measurements_page,
)

REQUIRED = {
    "stature",
    "weight",
    "chest_girth",
    "waist_girth_navel",
    "waist_girth_smallest",
    "hip_girth",
    "neck_girth",
    "thigh_girth",
    "calf_girth",
    "upper_arm_girth",
    "forearm_girth",
    "wrist_girth",
    "shoulder_breadth",
    "arm_length",
    "inseam",
}


def test_every_measurement_promised_is_defined_with_its_source():
    definitions = load_definitions()
    assert {d.about.name for d in definitions} >= REQUIRED
    for definition in definitions:
        assert definition.about.definition.endswith(".")
        assert definition.about.source.endswith(".")
        assert definition.about.unit in ("cm", "kg")


def test_every_measurement_says_how_it_stands_to_the_surveys():
    for entry in described():
        survey = entry["survey"]
        assert survey["definition"].endswith("."), entry["name"]
        assert survey["difference"].endswith("."), entry["name"]
        assert bool(survey["fields"]) == (survey["agreement"] != "absent")


def test_every_measurement_has_a_name_of_its_own():
    names = [definition.about.name for definition in load_definitions()]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("definition", load_definitions(), ids=lambda each: each.about.name)
def test_what_a_definition_names_exists_and_fits_together(definition):
    assert set(parts_of(definition)) <= set(NEEDED_PARTS)
    assert all(
        point.partition(":")[2] in NEEDED_PARTS
        for point in needed_points(definition)
        if point.startswith(JOINT_PREFIX)
    )
    match definition:
        case Girth():
            low, high = definition.fractions
            assert low <= high
        case Extent():
            assert definition.girth.orientation is Orientation.LEVEL
        case Contour():
            assert len(definition.sides) == len(definition.path) - 1


@pytest.mark.parametrize(
    ("name", "group"),
    [
        ("stature", Group.OVERALL),
        ("weight", Group.OVERALL),
        ("waist_girth_navel", Group.GIRTHS),
        ("trunk_girth", Group.GIRTHS),
        ("head_height", Group.HEIGHTS),
        ("shoulder_breadth", Group.BREADTHS),
        ("chest_depth", Group.BREADTHS),
        ("inseam", Group.LENGTHS),
        ("back_shoulder_width", Group.LENGTHS),
    ],
)
def test_a_name_tells_its_group(name, group):
    assert group_of(name) is group


def test_definitions_come_group_by_group():
    groups = [group_of(definition.about.name) for definition in load_definitions()]
    assert groups == sorted(groups, key=list(Group).index)


def test_what_is_shown_first_is_measured():
    names = [definition.about.name for definition in load_definitions()]
    assert set(CHIEF) <= set(names)
    assert len(set(CHIEF)) == len(CHIEF)


PAGE = Path(__file__).parents[3] / "MEASUREMENTS.md"


def test_the_page_of_measurements_is_the_one_the_definitions_make():
    assert PAGE.read_text(encoding="utf-8") == measurements_page()
