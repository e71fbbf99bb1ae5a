"""The list of what a container is made of: valid, and complete."""

import hashlib
import json
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any

import pytest
from cyclonedx.schema import SchemaVersion
from cyclonedx.validation.json import JsonStrictValidator

from fitter.detection.weights import BODY_LANDMARKS, PERSON_DETECTOR
from service.version import VERSION
from tests.unit.service.test_docker_files import runtime_requirements

REPOSITORY = Path(__file__).parents[2]
SCRIPT = REPOSITORY / "docker" / "sbom.py"


def write_list(output: Path) -> str:
    """Describe the tests' own environment."""
    command = [sys.executable, SCRIPT, "--python", sys.executable, "--output", output]
    command += ["--detector", Path(sys.prefix) / "lib"]
    subprocess.run(command, check=True, cwd=REPOSITORY)
    return output.read_text()


@pytest.fixture(scope="module")
def text(tmp_path_factory: pytest.TempPathFactory) -> str:
    return write_list(tmp_path_factory.mktemp("list") / "sbom.cdx.json")


def normal(name: str) -> str:
    return re.sub(r"[-_.]+", "-", name).lower()


def components(text: str, kind: str) -> dict[str, dict[str, Any]]:
    listed = json.loads(text)["components"]
    return {normal(each["name"]): each for each in listed if each["type"] == kind}


def test_it_is_cyclonedx(text: str):
    validator = JsonStrictValidator(SchemaVersion.V1_6)
    assert validator.validate_str(text) is None
    damaged = json.loads(text)
    damaged["components"] = [damaged["components"][0] | {"licenses": "free"}]
    assert validator.validate_str(json.dumps(damaged)) is not None


def libraries(text: str, registry: str) -> list[dict[str, Any]]:
    """The libraries that are known by a registry's names."""
    listed = components(text, "library").values()
    return [each for each in listed if each["purl"].startswith(f"pkg:{registry}/")]


def test_it_holds_what_a_container_runs_with_in_the_locked_versions_and_no_more(text: str):
    packages = {normal(each["name"]): each["version"] for each in libraries(text, "pypi")}
    assert packages == runtime_requirements()
    project = json.loads(text)["metadata"]["component"]
    assert (project["name"], project["version"]) == ("maquette", VERSION)


def test_it_holds_what_is_built_into_the_page_and_no_more(text: str):
    found = {
        (f"{each['group']}/" if "group" in each else "") + each["name"]: each
        for each in libraries(text, "npm")
    }
    notices = (REPOSITORY / "service/page/dist/THIRD_PARTY.txt").read_text()
    titles = {title.split(" ")[0] for title in re.findall(r"^(.*)\n={72}$", notices, re.MULTILINE)}
    assert set(found) == titles
    assert {"preact", "three", "@fontsource-variable/ibm-plex-sans"} <= titles
    locked = json.loads((REPOSITORY / "service/page/package-lock.json").read_text())["packages"]
    for name, each in found.items():
        package = locked[f"node_modules/{name}"]
        assert each["version"] == package["version"]
        assert each["licenses"][0]["license"]["id"] == package["license"]
        assert each["purl"] == f"pkg:npm/{name.replace('@', '%40')}@{package['version']}"


def test_it_is_refused_for_a_page_that_was_built_of_other_libraries(tmp_path: Path):
    copied = tmp_path / "service" / "page"
    shutil.copytree(REPOSITORY / "service/page/dist", copied / "dist")
    lock = (REPOSITORY / "service/page/package-lock.json").read_text()
    (copied / "package-lock.json").write_text(re.sub(r'"version": "[^"]+"', '"version": "0"', lock))
    command = [sys.executable, "-c", "import page_libraries; page_libraries.page_libraries()"]
    done = subprocess.run(
        command,
        cwd=tmp_path,
        env={"PYTHONPATH": str(SCRIPT.parent)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode != 0
    assert "another version: make page" in done.stderr


def natives(text: str, package: str) -> dict[str, dict[str, Any]]:
    """The libraries within a package, by name."""
    return {each["name"]: each for each in components(text, "library")[package]["components"]}


@pytest.mark.parametrize(
    ("package", "brought"),
    [
        ("opencv-python-headless", {"libavcodec", "libavformat", "libcrypto", "libssl", "libaom"}),
        ("psycopg-binary", {"libpq", "libcrypto", "libssl"}),
        ("pi-heif", {"libheif", "libde265"}),
        ("pillow", {"libjpeg", "libtiff", "libwebp"}),
        ("llvmlite", {"libllvmlite"}),
    ],
)
def test_native_libraries_are_named_within_the_package_whose_wheel_brings_them(
    text: str, package: str, brought: set[str]
):
    assert brought <= set(natives(text, package))


def test_every_file_of_a_native_library_is_listed_by_its_bytes(text: str):
    listed = {
        digest["content"]
        for package in components(text, "library").values()
        for part in package.get("components", ())
        for digest in part.get("hashes", ())
    }
    packages = Path(sysconfig.get_path("platlib"))
    names = ("opencv_python_headless", "psycopg_binary", "pi_heif", "pillow", "numpy", "scipy")
    files = [each for name in names for each in (packages / f"{name}.libs").iterdir()]
    assert len(files) > len(names)
    assert {hashlib.sha256(each.read_bytes()).hexdigest() for each in files} <= listed


def test_versions_are_those_of_the_files_and_of_the_wheel_s_own_list(text: str):
    brought = natives(text, "opencv-python-headless")
    assert re.fullmatch(r"[\d.]+[a-z]?", brought["libcrypto"]["version"])
    assert brought["openssl-libs"]["purl"].startswith("pkg:rpm/")
    assert natives(text, "pydantic-core")["serde"]["purl"].startswith("pkg:cargo/serde@")


def test_the_notice_names_what_comes_under_the_lesser_licence(text: str):
    notice = (REPOSITORY / "NOTICE").read_text()
    lesser = [
        name
        for name, each in components(text, "library").items()
        if "LGPL" in json.dumps(each.get("licenses", ()))
        or "Lesser General" in json.dumps(each.get("licenses", ()))
    ]
    assert {"psycopg", "psycopg-binary"} <= set(lesser)
    for name in lesser:
        assert f"`{name}`" in notice, name
    opencv = natives(text, "opencv-python-headless")
    ffmpeg = {each for each in opencv if each.startswith(("libav", "libsw"))} - {"libavif"}
    assert len(ffmpeg) == 5
    for name in {*ffmpeg, *natives(text, "pi-heif")}:
        assert name in notice, name


def test_everything_has_a_licence(text: str):
    for each in json.loads(text)["components"]:
        assert each.get("licenses"), each["name"]


def test_it_holds_the_networks_and_the_body_models_by_their_bytes(text: str):
    models = components(text, "machine-learning-model")
    digests = {each["name"]: each["hashes"][0]["content"] for each in models.values()}
    assert digests == {each.name: each.sha256 for each in (PERSON_DETECTOR, BODY_LANDMARKS)} | {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in (REPOSITORY / "fitter" / "body" / "data").glob("*.npz")
    }


def test_every_dependency_is_listed(text: str):
    listed = json.loads(text)
    known = {each["bom-ref"] for each in listed["components"]}
    root = listed["metadata"]["component"]["bom-ref"]
    for edges in listed["dependencies"]:
        assert edges["ref"] in known | {root}
        assert set(edges.get("dependsOn", ())) <= known


def test_it_is_the_same_each_time(text: str, tmp_path: Path):
    assert write_list(tmp_path / "again.json") == text
