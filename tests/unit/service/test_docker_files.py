import json
import os
import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path
from typing import Any

import pytest
import yaml
from packaging.requirements import Requirement

from fitter.detection.weights import FILES
from service.cli import parse
from service.settings import PREFIX, Settings

REPOSITORY = Path(__file__).parents[3]
DOCKER = REPOSITORY / "docker"
OURS = ("api", "worker")
RUNNING = ("api", "worker", "database", "storage")
SECRETS = {
    "POSTGRES_PASSWORD": "a-password",
    "DATABASE_PASSWORD": "another-password",
    "STORAGE_SECRET_KEY": "a-secret-key",
}


def instructions() -> list[tuple[str, str]]:
    """The Dockerfile's instructions, each with what follows it."""
    text = re.sub(r"^#.*\n", "", (DOCKER / "Dockerfile").read_text(), flags=re.MULTILINE)
    lines = re.sub(r"\\\n\s*", " ", text).splitlines()
    return [(line.split()[0], line.split(maxsplit=1)[1]) for line in lines if line.strip()]


def of_the_image(kind: str) -> list[str]:
    """The operands of one kind of instruction in the last stage, which is the image."""
    all_of_them = instructions()
    start = max(place for place, (name, _) in enumerate(all_of_them) if name == "FROM")
    return [operand for name, operand in all_of_them[start:] if name == kind]


def image_environment() -> dict[str, str]:
    return dict(pair.split("=", 1) for operand in of_the_image("ENV") for pair in operand.split())


def compose() -> dict[str, Any]:
    """The compose file with the variables it asks for."""
    text = (DOCKER / "compose.yaml").read_text()
    asked = set(re.findall(r"\$\{(\w+):\?", text))
    assert asked == set(SECRETS)
    text = re.sub(r"\$\{(\w+):\?[^}]*\}", lambda found: SECRETS[found[1]], text)
    return yaml.safe_load(re.sub(r"\$\{\w+:-([^}]*)\}", r"\1", text))


SERVICES = compose()["services"]


def accept(command: list[str]) -> None:
    """Parse a command as `maquette` would, which ends with status 2 if there is no such."""
    assert command[0] == "maquette"
    parse(command[1:])


@pytest.mark.parametrize("service", [None, *OURS])
def test_every_variable_of_ours_is_a_setting_of_a_value_that_can_be_followed(
    service, monkeypatch, tmp_path
):
    variables = image_environment() | (SERVICES[service]["environment"] if service else {})
    ours = {name: value for name, value in variables.items() if name.startswith(PREFIX)}
    assert {name.removeprefix(PREFIX).lower() for name in ours} <= set(Settings.model_fields)
    assert all(isinstance(value, str) for value in ours.values())
    for name in list(os.environ):
        if name.startswith(PREFIX):
            monkeypatch.delenv(name)
    for name, value in ours.items():
        monkeypatch.setenv(name, value)
    # This folder is the image's own.
    monkeypatch.setenv(f"{PREFIX}DETECTOR_DIR", str(tmp_path))
    settings = Settings()
    assert settings.authentication == "keys"
    assert settings.host == "0.0.0.0"


def test_the_detector_s_files_lie_where_the_image_says():
    (installed,) = [each for _, each in instructions() if "install -D" in each]
    folder = image_environment()[f"{PREFIX}DETECTOR_DIR"]
    words = installed[installed.index(f"-t {folder}") :].split()
    files = [Path(each).name for each in words if each.endswith(".tflite")]
    assert files == [each.name for each in FILES]


def test_every_command_is_one_of_ours():
    (default,) = of_the_image("CMD")
    accept(json.loads(default))
    (health,) = of_the_image("HEALTHCHECK")
    accept(json.loads(health[health.index("[") :]))
    for name in OURS:
        accept(SERVICES[name]["command"])
    for name in ("api", "worker"):
        kind, *command = SERVICES[name]["healthcheck"]["test"]
        assert kind == "CMD"
        accept(command)


@pytest.mark.parametrize("name", SERVICES)
def test_no_container_may_write_outside_its_volumes_or_gain_rights(name):
    service = SERVICES[name]
    assert service["read_only"] is True
    assert service["cap_drop"] == ["ALL"]
    assert service["security_opt"] == ["no-new-privileges:true"]
    assert service["tmpfs"]
    assert service["user"]
    assert "privileged" not in service
    assert "cap_add" not in service
    assert not any(volume.startswith(("/", ".")) for volume in service.get("volumes", []))


@pytest.mark.parametrize("name", SERVICES)
def test_every_container_has_limits(name):
    limits = SERVICES[name]["deploy"]["resources"]["limits"]
    assert set(limits) == {"memory", "pids"}


def test_every_service_is_asked_for_its_health_and_what_it_needs_comes_first():
    assert set(SERVICES) == set(RUNNING)
    for name in RUNNING:
        assert SERVICES[name]["healthcheck"]["test"][0] == "CMD"
        assert SERVICES[name]["restart"] == "unless-stopped"
    for name in ("api", "worker"):
        assert SERVICES[name]["depends_on"] == {
            needed: {"condition": "service_healthy"} for needed in ("database", "storage")
        }


def test_only_the_api_is_published_and_only_on_this_host():
    published = {name: service["ports"] for name, service in SERVICES.items() if "ports" in service}
    assert published == {"api": ["127.0.0.1:8000:8000"]}
    assert compose()["networks"] == {"inside": {"internal": True}, "outside": None}


def test_only_the_api_which_sends_notices_has_a_way_out():
    with_a_way_out = {name for name, each in SERVICES.items() if each["networks"] != ["inside"]}
    assert with_a_way_out == {"api"}
    assert SERVICES["api"]["networks"] == ["inside", "outside"]


def test_secrets_come_from_outside_and_both_ends_are_told_the_same():
    api, database, storage = (SERVICES[name]["environment"] for name in ("api", *RUNNING[2:]))
    assert api["PGPASSWORD"] == database["ROLE_PASSWORD"] == SECRETS["DATABASE_PASSWORD"]
    assert database["POSTGRES_PASSWORD"] == SECRETS["POSTGRES_PASSWORD"]
    assert SECRETS["POSTGRES_PASSWORD"] not in api.values()
    assert api["AWS_ACCESS_KEY_ID"] == storage["ROOT_ACCESS_KEY_ID"]
    assert (
        api["AWS_SECRET_ACCESS_KEY"]
        == storage["ROOT_SECRET_ACCESS_KEY"]
        == SECRETS["STORAGE_SECRET_KEY"]
    )
    assert api["MAQUETTE_DATABASE_URL"] == "postgresql://maquette@database/maquette"


def test_the_script_that_makes_the_database_s_role_is_put_where_postgres_looks():
    (mounted,) = SERVICES["database"]["configs"]
    assert mounted["target"].startswith("/docker-entrypoint-initdb.d/")
    script = (DOCKER / compose()["configs"][mounted["source"]]["file"]).read_text()
    told = set(SERVICES["database"]["environment"])
    assert set(re.findall(r"\$\{?(\w+)", script)) - {"POSTGRES_USER"} <= told


def test_a_worker_is_given_longer_than_it_takes_to_stop():
    environment = SERVICES["worker"]["environment"]
    drain_s = float(environment.get("MAQUETTE_DRAIN_S", Settings.model_fields["drain_s"].default))
    assert float(SERVICES["worker"]["stop_grace_period"].removesuffix("s")) >= drain_s + 5.0


def test_what_is_copied_exists_and_is_let_through():
    let_through = {
        line.removeprefix("!")
        for line in (DOCKER / "Dockerfile.dockerignore").read_text().splitlines()
        if line.startswith("!")
    }
    copied = {
        source
        for name, operand in instructions()
        if name == "COPY" and "--from" not in operand
        for source in operand.split()[:-1]
        if not source.startswith("--")
    }
    # Of the page only what is served and which libraries are in it, not what it is built from.
    of_the_page = {"service/page/dist", "service/page/package-lock.json"}
    within = {each for each in copied if any(each.startswith(f"{path}/") for path in let_through)}
    assert copied - within == let_through - of_the_page
    assert all((REPOSITORY / name).exists() for name in let_through)
    packages = tomllib.loads((REPOSITORY / "pyproject.toml").read_text())["tool"]["hatch"]
    assert set(packages["build"]["targets"]["wheel"]["packages"]) <= copied


def test_the_lock_file_names_versions_and_no_place():
    lock = (REPOSITORY / "requirements.lock").read_text()
    assert "://" not in lock
    lines = [line for line in lock.splitlines() if line and not line.lstrip().startswith("#")]
    packages = [line for line in lines if not line.startswith(" ")]
    assert all(re.fullmatch(r"[\w.-]+==[\w.]+( ; .+)? \\", line) for line in packages)


@pytest.mark.parametrize("name", ["lock", "detector", "training"])
def test_every_package_is_pinned_with_the_hashes_of_its_files(name):
    file = "requirements.lock" if name == "lock" else f"requirements-{name}.txt"
    text = (REPOSITORY / file).read_text()
    packages = re.findall(r"^(\S+) \\\n((?:    --hash=sha256:[0-9a-f]{64}(?: \\)?\n)+)", text, re.M)
    assert [pinned for pinned, _ in packages] == re.findall(r"^[\w.-]+==\S+", text, re.M)
    assert packages


def runtime_requirements() -> dict[str, str]:
    """What the image is built with: versions by name."""
    printed = subprocess.run(
        [
            *(sys.executable, DOCKER / "runtime_requirements.py"),
            *(REPOSITORY / "pyproject.toml", REPOSITORY / "requirements.lock"),
        ],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    return dict(re.findall(r"^([\w.-]+)==(\S+)", printed, re.M))


def test_the_image_gets_what_the_service_runs_on_and_no_tools():
    names = runtime_requirements().keys()
    assert {"dbos", "numba", "boto3", "pi-heif"} <= names
    assert names.isdisjoint({"pytest", "ruff", "pyright", "moto", "mitsuba"})


def test_the_image_gets_all_that_its_packages_say_they_need():
    printed = runtime_requirements()
    for name in printed:
        for line in metadata.requires(name) or ():
            requirement = Requirement(line)
            if requirement.marker is None or requirement.marker.evaluate({"extra": ""}):
                needed = re.sub(r"[-_.]+", "-", requirement.name).lower()
                assert needed in printed, f"{name} needs {line}"
                assert requirement.specifier.contains(printed[needed])
