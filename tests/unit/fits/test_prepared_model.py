from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fitter.body.model import BodyModel, SparseRows
from fitter.body.storage import load_body_model, packaged_model_path, save_body_model
from fitter.errors import ModelFileError
from fitter.fits.prepared_model import NEEDED_PARTS, needed_landmarks, prepared_model
from fitter.request import Gender
from fitter.training.assemble import model_arrays


@cache
def packaged() -> BodyModel:
    return load_body_model(packaged_model_path("female"))


def save(path: Path, model: BodyModel) -> None:
    header = dict(model.header) | {
        "part_names": list(model.part_names),
        "landmark_names": list(model.landmarks.names),
    }
    save_body_model(path, header=header, arrays=model_arrays(model))


def without(rows: SparseRows, name: str) -> SparseRows:
    kept = np.repeat(np.array(rows.names) != name, np.diff(rows.pointers))
    lengths = [
        length
        for other, length in zip(rows.names, np.diff(rows.pointers), strict=True)
        if other != name
    ]
    return SparseRows(
        names=tuple(other for other in rows.names if other != name),
        pointers=np.cumsum([0, *lengths]),
        indices=rows.indices[kept],
        weights=rows.weights[kept],
    )


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


def test_a_man_under_a_womans_name_is_refused(tmp_path):
    content = packaged_model_path("male").read_bytes()
    (tmp_path / "female.npz").write_bytes(content)
    with pytest.raises(ModelFileError, match=r"header\.gender is male, expected female"):
        prepared_model(Gender.FEMALE, models=tmp_path)
