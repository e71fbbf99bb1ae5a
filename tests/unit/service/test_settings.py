import re
from pathlib import Path

import pytest
from pydantic import ValidationError

from service.settings import PREFIX, Settings

README = Path(__file__).parents[3] / "README.md"


def test_settings_survive_the_way_through_the_environment(monkeypatch):
    settings = Settings(port=1234, data_dir=Path("somewhere"), job_time_limit_s=7.5)
    for name, value in settings.environment().items():
        monkeypatch.setenv(name, value)
    assert Settings() == settings


def test_a_folder_of_models_must_hold_both(tmp_path):
    (tmp_path / "female.npz").touch()
    with pytest.raises(ValidationError, match=r"no male\.npz"):
        Settings(models_dir=tmp_path)
    (tmp_path / "male.npz").touch()
    assert Settings(models_dir=tmp_path).models_dir == tmp_path


def test_every_setting_says_what_it_is_for():
    assert all(field.description for field in Settings.model_fields.values())


def test_the_database_is_embedded_unless_one_is_named(tmp_path):
    embedded = Settings(data_dir=tmp_path)
    assert embedded.system_database_url == f"sqlite:///{tmp_path}/maquette.sqlite"
    named = Settings(data_dir=tmp_path, database_url="postgresql://host/name")
    assert named.system_database_url == "postgresql://host/name"


def test_the_readme_lists_every_setting_with_default_and_meaning_and_no_other():
    listed = {
        name: (default, meaning)
        for name, default, meaning in re.findall(
            rf"^\| `({PREFIX}\w+)` \| (.*?) \| (.*) \|$", README.read_text(), re.MULTILINE
        )
    }
    assert list(listed) == [PREFIX + name.upper() for name in Settings.model_fields]
    for name, field in Settings.model_fields.items():
        default, meaning = listed[PREFIX + name.upper()]
        assert meaning == field.description, name
        if field.default_factory is None:
            shown = "" if field.default in (None, "") else f"`{field.default}`"
            assert default == shown, name


def test_without_keys_only_this_machine_is_listened_to():
    for host in ("0.0.0.0", "::", "192.168.1.5", "example.org"):
        with pytest.raises(ValidationError, match="maquette keys create"):
            Settings(host=host)
        assert Settings(host=host, authentication="keys").host == host
    for host in ("127.0.0.1", "127.0.0.2", "::1", "localhost"):
        assert Settings(host=host).authentication == "off"


def test_origins_are_read_as_a_list_and_a_page_is_no_origin():
    settings = Settings(cors_origins="https://a.example, http://localhost:5173")
    assert settings.allowed_origins == ("https://a.example", "http://localhost:5173")
    with pytest.raises(ValidationError, match="origin"):
        Settings(cors_origins="https://a.example/page")
    with pytest.raises(ValidationError, match="origin"):
        Settings(cors_origins="*")


def test_object_storage_is_named_by_bucket():
    assert Settings(blob_url="s3://bucket/prefix").blob_url == "s3://bucket/prefix"
    with pytest.raises(ValidationError, match="s3://"):
        Settings(blob_url="https://bucket")


@pytest.mark.parametrize(
    ("name", "value"), [("port", -1), ("max_crashes", 0), ("job_time_limit_s", 0)]
)
def test_a_senseless_setting_is_refused(name, value):
    with pytest.raises(ValidationError, match=name):
        Settings(**{name: value})


def test_the_pauses_between_notices_are_seconds():
    assert Settings(webhook_pauses_s="5, 300,0.5").webhook_schedule_s == (5.0, 300.0, 0.5)
    for pauses in ("", "5,,6", "soon", "-1", "5;6"):
        with pytest.raises(ValidationError, match="seconds"):
            Settings(webhook_pauses_s=pauses)


def test_the_secret_of_notices_is_checked_and_not_shown():
    with pytest.raises(ValidationError, match="whsec_"):
        Settings(webhook_secret="secret")
    secret = "whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD"
    assert secret not in repr(Settings(webhook_secret=secret))
