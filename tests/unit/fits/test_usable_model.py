from dataclasses import replace

import pytest

from fitter.errors import ModelFileError
from fitter.fits.equipment import prepared_model
from fitter.fits.usable_model import NEEDED_PARTS, needed_landmarks
from fitter.vocabulary.choices import Gender
from tests.changed_models import packaged, save, without


def test_the_packaged_models_have_what_a_fit_needs():
    assert set(NEEDED_PARTS) == set(packaged().part_names)
    assert set(needed_landmarks()) <= set(packaged().landmarks.names)


def test_a_landmark_a_fit_needs_is_missed_by_name(tmp_path):
    lacking = without(packaged().landmarks, "navel")
    save(tmp_path / "female.npz", replace(packaged(), landmarks=lacking))
    with pytest.raises(ModelFileError, match=r"landmark_names lacks .*: navel\. .*OWN_BODIES"):
        prepared_model(Gender.FEMALE, models=tmp_path)


def test_a_part_of_another_name_is_missed(tmp_path):
    names = tuple("skull" if name == "head" else name for name in packaged().part_names)
    save(tmp_path / "female.npz", replace(packaged(), part_names=names))
    with pytest.raises(ModelFileError, match=r"part_names lacks .*: head\."):
        prepared_model(Gender.FEMALE, models=tmp_path)
