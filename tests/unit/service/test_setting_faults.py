"""What is said of settings that cannot be followed: the variable, its value, what to do."""

import pytest
from pydantic import ValidationError

from service.settings import Settings
from service.startup import fault_lines, unknown_names


def lines(*, options: tuple[str, ...] = (), **given: object) -> list[str]:
    with pytest.raises(ValidationError) as refused:
        Settings(**given)
    return list(fault_lines(refused.value, options=options))


def test_a_fault_names_variable_value_and_remedy_in_one_line():
    way_out = "correct it, or unset it for the default"
    assert lines(retention_hours="inf") == [
        f"MAQUETTE_RETENTION_HOURS=inf: it must be a finite number; {way_out}, 168.0."
    ]
    assert lines(heartbeat_s="1e308") == [
        f"MAQUETTE_HEARTBEAT_S=1e308: it must be at most 3600; {way_out}, 2.0."
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
    assert "postgresql://" in line


def test_a_slip_of_a_name_is_told_with_the_nearest_name():
    environment = {
        "MAQUETTE_RETENTION_HUORS": "1",
        "MAQUETTE_PORT": "8000",
        "maquette_port": "8000",
        "maquette_datadir": "somewhere",
        "MAQUETTE_ZZZ": "1",
        "PATH": "/bin",
    }
    assert unknown_names(environment) == {
        "MAQUETTE_RETENTION_HUORS": "MAQUETTE_RETENTION_HOURS",
        "MAQUETTE_ZZZ": None,
        "maquette_datadir": "MAQUETTE_DATA_DIR",
    }
