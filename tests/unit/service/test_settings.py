from pathlib import Path

import pytest
from pydantic import ValidationError

from service.settings import Settings


def test_settings_survive_the_way_through_the_environment(monkeypatch):
    settings = Settings(port=1234, data_dir=Path("somewhere"), job_time_limit_s=7.5)
    for name, value in settings.environment().items():
        monkeypatch.setenv(name, value)
    assert Settings() == settings


def test_every_setting_says_what_it_is_for():
    assert all(field.description for field in Settings.model_fields.values())


def test_the_database_is_embedded_unless_one_is_named(tmp_path):
    embedded = Settings(data_dir=tmp_path)
    assert embedded.system_database_url == f"sqlite:///{tmp_path}/maquette.sqlite"
    named = Settings(data_dir=tmp_path, database_url="postgresql://host/name")
    assert named.system_database_url == "postgresql://host/name"


@pytest.mark.parametrize(
    ("name", "value"), [("port", -1), ("max_crashes", 0), ("job_time_limit_s", 0)]
)
def test_a_senseless_setting_is_refused(name, value):
    with pytest.raises(ValidationError, match=name):
        Settings(**{name: value})
