"""Whether the body models can be used, asked of the real files and of damaged copies."""

import shutil
from pathlib import Path

import pytest

from service.compute import models_reading
from service.compute.models_reading import PACKAGED, check_models
from service.settings import SettingError, Settings


@pytest.fixture
def packaged(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The packaged models, as if this copy had been installed."""
    copy = Path(shutil.copytree(PACKAGED, tmp_path / "data"))
    monkeypatch.setattr(models_reading, "PACKAGED", copy)
    return copy


def refused(settings: Settings) -> str:
    with pytest.raises(SettingError) as caught:
        check_models(settings)
    message = str(caught.value)
    assert "\n" not in message
    return message


def test_the_packaged_models_can_be_used(packaged: Path):
    check_models(Settings())


def test_a_packaged_model_that_is_missing_cut_or_changed_is_told(packaged: Path):
    path = packaged / "male.npz"
    whole = path.read_bytes()
    middle = len(whole) // 2
    changed = whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :]
    for content in (whole[:-1_000], b"", changed):
        path.write_bytes(content)
        assert "male.npz is damaged" in refused(Settings())
    path.unlink()
    assert "male.npz" in refused(Settings())


def test_a_model_of_one_s_own_is_read_whole(packaged: Path):
    """A file of the other gender is undamaged, and still of no use."""
    check_models(Settings(models_dir=packaged))
    shutil.copy(packaged / "female.npz", packaged / "male.npz")
    message = refused(Settings(models_dir=packaged))
    assert message.startswith(f"MAQUETTE_MODELS_DIR={packaged}: male.npz")
