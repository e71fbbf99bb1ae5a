import json

import pytest

from fitter.errors import DefinitionError
from fitter.measurement.definition_file import DEFINITIONS_PATH, load_definitions
from fitter.measurement.definitions import Agreement, Girth, check_against_model
from tests.unit.body.synthetic_model import bar_model

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


@pytest.fixture
def document():
    return json.loads(DEFINITIONS_PATH.read_text(encoding="utf-8"))


def load_changed(document, tmp_path):
    path = tmp_path / "definitions.json"
    path.write_text(json.dumps(document), encoding="utf-8")
    return load_definitions(path)


def girth_entry(document):
    return next(entry for entry in document["measurements"] if entry["kind"] == "girth")


def test_every_measurement_promised_is_defined_with_its_source():
    definitions = load_definitions()
    assert {d.about.name for d in definitions} >= REQUIRED
    for definition in definitions:
        assert definition.about.definition.endswith(".")
        assert definition.about.source.endswith(".")
        assert definition.about.unit in ("cm", "kg")


def test_every_measurement_says_how_it_stands_to_the_surveys():
    for definition in load_definitions():
        survey = definition.about.survey
        assert survey.definition.endswith("."), definition.about.name
        assert survey.difference.endswith("."), definition.about.name
        assert bool(survey.fields) == (survey.agreement is not Agreement.ABSENT)


def test_fields_of_a_survey_that_does_not_take_the_measurement_are_refused(document, tmp_path):
    entry = girth_entry(document)
    entry["survey"]["agreement"] = "absent"
    with pytest.raises(DefinitionError, match=f"{entry['name']}: survey: fields is"):
        load_changed(document, tmp_path)


def test_a_missing_field_is_named_with_its_measurement(document, tmp_path):
    entry = girth_entry(document)
    del entry["parts"]
    with pytest.raises(DefinitionError, match=f"{entry['name']}: parts is missing"):
        load_changed(document, tmp_path)


@pytest.mark.parametrize(
    ("field", "value", "fault"),
    [
        ("fractions", [0.6, 0.2], "runs from 0.6 down to 0.2"),
        ("fractions", [0.6], "not two numbers"),
        ("selection", "median", "not one of largest, smallest"),
        ("parts", [], "not a list of names"),
        ("around_axis", 1, "not of type bool"),
        ("start", "navel", "not of type list"),
        ("kind", "girthy", "kind 'girthy' is not known"),
        ("unit", "inch", "not one of cm, kg"),
    ],
)
def test_a_wrong_value_is_named(document, tmp_path, field, value, fault):
    girth_entry(document)[field] = value
    with pytest.raises(DefinitionError, match=fault):
        load_changed(document, tmp_path)


def test_a_measurement_defined_twice_is_refused(document, tmp_path):
    document["measurements"].append(document["measurements"][0])
    with pytest.raises(DefinitionError, match="is defined 2 times"):
        load_changed(document, tmp_path)


def test_another_format_version_is_refused(document, tmp_path):
    document["format_version"] = 99
    with pytest.raises(DefinitionError, match="format_version"):
        load_changed(document, tmp_path)


def test_a_file_that_is_no_json_is_refused(tmp_path):
    path = tmp_path / "definitions.json"
    path.write_text("{", encoding="utf-8")
    with pytest.raises(DefinitionError, match="cannot be read as JSON"):
        load_definitions(path)


def test_a_model_without_the_landmark_is_refused_by_name():
    with pytest.raises(
        DefinitionError, match="head_girth: the female body model has no point left_eye"
    ):
        check_against_model(load_definitions(), bar_model())


def test_a_model_without_the_part_is_refused_by_name():
    calf = next(
        d for d in load_definitions() if isinstance(d, Girth) and d.about.name == "calf_girth"
    )
    with pytest.raises(DefinitionError, match=r"calf_girth: .* has no point joint:right_shin"):
        check_against_model([calf], bar_model())
