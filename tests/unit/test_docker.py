"""The image: what it is made of and runs, by itself, by compose and by Kubernetes."""

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path
from typing import Any

import botocore
import pytest
import yaml
from packaging.requirements import Requirement

from fitter.detection.weights import FILES
from service.cli import parse
from service.settings import PREFIX, Settings
from service.version import VERSION

REPOSITORY = Path(__file__).parents[2]
DOCKER = REPOSITORY / "docker"
OURS = ("api", "worker")
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


DIGEST = "sha256:" + 64 * "a"
TAGGED = "python:3.13-slim-trixie"


def build_check(**arguments: str) -> subprocess.CompletedProcess[str]:
    """Run the Dockerfile's check of its arguments, as a build would."""
    (check,) = [each for name, each in instructions() if name == "RUN" and "${BASE_IMAGE}" in each]
    return subprocess.run(
        ["sh", "-c", check],
        cwd=REPOSITORY,
        env={"PATH": os.environ["PATH"], "VERSION": "", **arguments},
        capture_output=True,
        text=True,
        check=False,
    )


def named_images() -> dict[str, str]:
    lines = (DOCKER / "images.env").read_text().splitlines()
    return dict(line.split("=", 1) for line in lines if line and not line.startswith("#"))


def test_an_image_to_try_things_out_stands_on_any_base():
    assert build_check(BASE_IMAGE=TAGGED).returncode == 0


def test_a_release_is_refused_on_a_base_that_may_change():
    refused = build_check(BASE_IMAGE=TAGGED, VERSION=VERSION)
    assert refused.returncode != 0
    assert "digest" in refused.stderr
    assert build_check(BASE_IMAGE=f"{TAGGED}@{DIGEST}", VERSION=VERSION).returncode == 0


def test_a_release_is_refused_by_a_version_that_is_not_the_project_s():
    refused = build_check(BASE_IMAGE=f"{TAGGED}@{DIGEST}", VERSION=f"{VERSION}1")
    assert refused.returncode != 0
    assert "another version" in refused.stderr


def test_files_that_name_an_image_name_the_same():
    named = {name: image.partition("@")[0] for name, image in named_images().items()}
    compose = (DOCKER / "compose.yaml").read_text()
    assert dict(re.findall(r"\$\{(\w+_IMAGE):-([^}]+)\}", compose)) == named
    assert ("ARG", f"BASE_IMAGE={named['BASE_IMAGE']}") in instructions()


MANIFESTS = list(yaml.safe_load_all((REPOSITORY / "docker" / "kubernetes.yaml").read_text()))
(SETTINGS,) = (each["data"] for each in MANIFESTS if each["kind"] == "ConfigMap")
PODS: dict[str, Any] = {
    each["metadata"]["name"]: each["spec"]["template"]["spec"]
    for each in MANIFESTS
    if each["kind"] == "Deployment"
}


def container(pod: Any) -> Any:
    (only,) = pod["containers"]
    return only


def test_the_map_holds_settings_that_can_be_followed():
    named = {
        name.removeprefix(PREFIX).lower(): value
        for name, value in SETTINGS.items()
        if name.startswith(PREFIX)
    }
    assert named.keys() <= Settings.model_fields.keys()
    # Nothing is kept in a pod.
    assert not Settings.model_validate_strings(named).uses_data_folder


@pytest.mark.parametrize("name", PODS)
def test_every_pod_runs_our_image_with_a_command_of_ours(name):
    only = container(PODS[name])
    assert only["image"].endswith(f"/maquette:{VERSION}")
    asked = [only["args"], *(each["exec"]["command"] for each in _probes(only) if "exec" in each)]
    for program, *arguments in asked:
        assert program == "maquette"
        parse(arguments)


def test_a_pod_is_given_longer_than_it_takes_to_stop():
    given = {name: pod["terminationGracePeriodSeconds"] for name, pod in PODS.items()}
    assert given["worker"] >= float(SETTINGS[f"{PREFIX}DRAIN_S"]) + 20.0
    assert given["api"] >= float(SETTINGS[f"{PREFIX}STOP_DELAY_S"]) + 20.0


def _probes(only: Any) -> list[Any]:
    return [value for name, value in only.items() if name.endswith("Probe")]


SCRIPT = Path(__file__).parents[2] / "docker" / "cut_packages.py"

GONE = (
    "numpy/lib/tests/data/array.npy",
    "numpy/lib/tests/tests/test_it.py",
    "numpy/_core/include/arrays.h",
    "ai_edge_litert/libLiteRtWebGpuAccelerator.so",
    "ai_edge_litert/tools/convert.py",
    "botocore/data/ec2/service-2.json.gz",
)
LEFT = (
    "numpy/lib/arrays.py",
    "numpy/testing/overrides.py",
    "trimesh/__init__.pyi",
    "ai_edge_litert/libLiteRt.so",
    "botocore/data/endpoints.json",
    "botocore/data/s3/service-2.json.gz",
)


def cut(folder: Path) -> str:
    command = [sys.executable, SCRIPT, folder]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def test_what_a_service_never_reads_is_erased_and_nothing_else(tmp_path: Path):
    for name in (*GONE, *LEFT):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(bytes(1_000_000))
    printed = cut(tmp_path)
    left = {str(each.relative_to(tmp_path)) for each in tmp_path.rglob("*") if each.is_file()}
    assert left == set(LEFT)
    assert [line.split()[0] for line in printed.splitlines()] == ["2.0", "1.0", "1.0", "2.0"]


@pytest.fixture
def storage_client_alone(tmp_path: Path) -> Path:
    """botocore as the image has it."""
    shutil.copytree(Path(botocore.__file__).parent, tmp_path / "botocore")
    cut(tmp_path)
    return tmp_path


def test_the_storage_s_client_can_be_made_of_what_is_left(storage_client_alone: Path):
    made = (
        "import boto3, botocore; print(botocore.__file__);"
        "client = boto3.client('s3', region_name='eu-central-1');"
        "print(client.get_paginator('list_objects_v2'), client.get_waiter('bucket_exists'))"
    )
    done = subprocess.run(
        [sys.executable, "-c", made],
        env={"PYTHONPATH": str(storage_client_alone), "AWS_ACCESS_KEY_ID": "key"}
        | {"AWS_SECRET_ACCESS_KEY": "secret"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(storage_client_alone))
