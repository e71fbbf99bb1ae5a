"""Settings: what is read, and what is said of those that cannot be followed."""

import re
from pathlib import Path

import pytest
from pydantic import ValidationError

from service.settings import PREFIX, Settings
from service.startup import fault_lines, unknown_names

LIST = Path(__file__).parents[3] / "service" / "docs" / "operate" / "settings.md"


def test_settings_survive_the_way_through_the_environment(monkeypatch):
    settings = Settings(port=1234, data_dir=Path("somewhere"), job_time_limit_s=7.5)
    for name, value in settings.environment().items():
        monkeypatch.setenv(name, value)
    assert Settings() == settings


def test_an_empty_variable_counts_as_unset(monkeypatch):
    for name in Settings.model_fields:
        monkeypatch.setenv(PREFIX + name.upper(), "")
    assert Settings() == Settings.model_construct()


def test_the_database_is_embedded_unless_one_is_named(tmp_path):
    embedded = Settings(data_dir=tmp_path)
    assert embedded.system_database_url == f"sqlite:///{tmp_path}/maquette.sqlite"
    named = Settings(data_dir=tmp_path, database_url="postgresql://host/name")
    assert named.system_database_url == "postgresql://host/name"


def test_the_documents_list_every_setting_with_default_and_meaning_and_no_other():
    listed = {
        name: (default, meaning)
        for name, default, meaning in re.findall(
            rf"^\| `({PREFIX}\w+)` \| (.*?) \| (.*) \|$", LIST.read_text(), re.MULTILINE
        )
    }
    assert list(listed) == [PREFIX + name.upper() for name in Settings.model_fields]
    for name, field in Settings.model_fields.items():
        default, meaning = listed[PREFIX + name.upper()]
        assert meaning == field.description, name
        if field.default_factory is None:
            shown = "" if field.default in (None, ()) else f"`{field.default}`"
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
    assert settings.cors_origins == ("https://a.example", "http://localhost:5173")
    with pytest.raises(ValidationError, match="cors_origins"):
        Settings(cors_origins="https://a.example/page")
    with pytest.raises(ValidationError, match="cors_origins"):
        Settings(cors_origins="*")


def test_object_storage_is_named_by_bucket():
    assert Settings(blob_url="s3://bucket/prefix").blob_url == "s3://bucket/prefix"
    with pytest.raises(ValidationError, match="blob_url"):
        Settings(blob_url="https://bucket")


@pytest.mark.parametrize(
    "name", ["b", "no bucket", "-bucket", "bucket_", "key@bucket", "bucket:9000", "a" * 256]
)
def test_a_bucket_that_no_server_takes_is_refused(name: str):
    with pytest.raises(ValidationError, match="blob_url"):
        Settings(blob_url=f"s3://{name}")


@pytest.mark.parametrize("url", ["s3://bucket?x=1", "s3://bucket#x"])
def test_a_bucket_has_no_more_than_a_prefix(url: str):
    with pytest.raises(ValidationError, match="blob_url"):
        Settings(blob_url=url)


@pytest.mark.parametrize("name", ["maquette", "my.bucket-1", "Old_Bucket"])
def test_a_bucket_that_some_server_takes_is_accepted(name: str):
    assert Settings(blob_url=f"s3://{name}/prefix").blob_url == f"s3://{name}/prefix"


@pytest.mark.parametrize(
    ("name", "value"), [("port", -1), ("max_crashes", 0), ("job_time_limit_s", 0)]
)
def test_a_senseless_setting_is_refused(name, value):
    with pytest.raises(ValidationError, match=name):
        Settings(**{name: value})


def numbers(kind: type) -> list[str]:
    return [name for name, field in Settings.model_fields.items() if field.annotation is kind]


@pytest.mark.parametrize("value", ["inf", "-inf", "nan", "1e308"])
@pytest.mark.parametrize("name", numbers(float))
def test_no_time_is_endless_or_none(name: str, value: str):
    with pytest.raises(ValidationError, match=name):
        Settings(**{name: value})


@pytest.mark.parametrize("name", numbers(int))
def test_every_count_has_a_bound(name: str):
    with pytest.raises(ValidationError, match=name):
        Settings(**{name: 10**30})


def test_the_longest_times_allowed_can_be_counted_with():
    longest = Settings(retention_hours=87_600, drain_s=86_400, sweep_interval_s=86_400)
    assert longest.retention_s == 10 * 365 * 86_400


def test_a_worker_is_not_taken_for_dead_between_two_beats():
    with pytest.raises(ValidationError, match="at least 20"):
        Settings(heartbeat_s=10.0, dead_after_s=15.0)
    assert Settings(heartbeat_s=10.0, dead_after_s=20.0).dead_after_s == 20.0


@pytest.mark.parametrize("scheme", ["postgresql", "postgres", "postgresql+psycopg"])
def test_a_postgres_database_may_be_called_by_its_short_name(scheme: str):
    settings = Settings(database_url=f"{scheme}://user:p%40ss@host:5433/name?sslmode=require")
    address = "postgresql://user:p%40ss@host:5433/name?sslmode=require"
    assert settings.system_database_url == address
    assert "p%40ss" not in repr(settings)


@pytest.mark.parametrize(
    "url", ["", "mysql://host/name", "sqlite:///file", "host/name", "postgresql://host:many/name"]
)
def test_another_database_is_refused(url: str):
    with pytest.raises(ValidationError, match="database_url"):
        Settings(database_url=url)


@pytest.mark.parametrize("hosts", ["https://host", "host:8080", "a.example, b.example/hook"])
def test_hosts_for_notices_are_names_alone(hosts: str):
    with pytest.raises(ValidationError, match="webhook_hosts"):
        Settings(webhook_hosts=hosts)
    assert Settings(webhook_hosts="localhost, 127.0.0.1, ::1").webhook_hosts


def test_the_secret_of_notices_is_checked_and_not_shown():
    with pytest.raises(ValidationError, match="whsec_"):
        Settings(webhook_secret="secret")
    secret = "whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD"
    assert secret not in repr(Settings(webhook_secret=secret))


def lines(*, options: tuple[str, ...] = (), **given: object) -> list[str]:
    with pytest.raises(ValidationError) as refused:
        Settings(**given)
    return list(fault_lines(refused.value, options=options))


def test_a_fault_names_variable_value_and_remedy_in_one_line():
    way_out = "correct it, or unset it"
    assert lines(retention_hours="inf") == [
        f"MAQUETTE_RETENTION_HOURS=inf: Input should be a finite number; {way_out}."
    ]
    assert lines(heartbeat_s="1e308") == [
        f"MAQUETTE_HEARTBEAT_S=1e308: Input should be less than or equal to 3600; {way_out}."
    ]


def test_every_fault_has_a_line_of_its_own():
    found = lines(port="many", max_queued="0")
    assert [line.partition("=")[0] for line in found] == ["MAQUETTE_PORT", "MAQUETTE_MAX_QUEUED"]


def test_what_was_given_as_an_option_is_called_so():
    assert lines(options=("port",), port=-1)[0].startswith("--port=-1: ")


def test_a_value_of_several_lines_is_shown_in_one():
    (line,) = lines(cors_origins="https://a.example/\nhttps://b.example")
    assert "\n" not in line


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("webhook_secret", "whsec_opensesame"),
        ("database_url", "mysql://user:opensesame@host/name"),
        ("database_url", "postgresql://user:open/opensesame@host/name"),
        ("database_url", "mysql://host/name?password=opensesame"),
        ("blob_url", "https://key:opensesame@bucket"),
    ],
)
def test_secrets_are_not_shown(name: str, value: str):
    (line,) = lines(**{name: value})
    assert line.startswith(f"MAQUETTE_{name.upper()}=")
    assert "opensesame" not in line


def test_the_user_and_host_of_a_database_are_shown():
    (line,) = lines(database_url="mysql://user:secret@host:3306/name")
    assert "mysql://user:***@host:3306/name" in line
    assert "'postgresql'" in line


def test_names_of_no_setting_are_found():
    environment = dict.fromkeys(
        ("MAQUETTE_RETENTION_HUORS", "MAQUETTE_PORT", "maquette_port", "maquette_datadir", "PATH"),
        "",
    )
    assert unknown_names(environment) == ["MAQUETTE_RETENTION_HUORS", "maquette_datadir"]
