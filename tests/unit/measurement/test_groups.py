import pytest

from fitter.measurement.definition_file import load_definitions
from fitter.vocabulary.measurements import CHIEF, Group, group_of


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
