"""The wheel and the source distribution."""

import ast
import re
import subprocess
import sys
from importlib.metadata import packages_distributions
from pathlib import Path
from zipfile import ZipFile

import pytest
from packaging.metadata import RawMetadata, parse_email
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from service.version import VERSION
from tests.installation import applies, built

REPOSITORY = Path(__file__).parents[2]
EXTRAS = ("s3", "detector", "heic")
"""Of users; the others are for those who develop and evaluate."""

COMPANIONS = ("pydantic_core", "botocore")
"""Of pydantic and boto3, which each bring their own in the version that fits, and document it."""

PACKAGES = ("api_schemas", "fitter", "service")
MAX_WHEEL_BYTES = 20_000_000

NOT_INSTALLED = (
    r"service/page/(?!dist/).*",
    r"service/demo_data/(moving\.webp|(result|measuring|page_clicking|page_result)\.jpg)",
    r"fitter/measurement/atlas/.*",
    r"service/docs/.*",
    r"api_schemas/(released|typescript)/.*",
)
"""Sources of the page, documents and their pictures, documents of earlier versions."""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return built(REPOSITORY, "wheel", tmp_path_factory.mktemp("wheel"))


@pytest.fixture(scope="module")
def files(wheel: Path) -> set[str]:
    with ZipFile(wheel) as archive:
        return set(archive.namelist())


@pytest.fixture(scope="module")
def metadata(wheel: Path) -> RawMetadata:
    with ZipFile(wheel) as archive:
        (name,) = (name for name in archive.namelist() if name.endswith(".dist-info/METADATA"))
        known, unknown = parse_email(archive.read(name))
    assert not unknown
    return known


def test_the_wheel_holds_every_file_that_runs_and_no_other(files: set[str]):
    if not (REPOSITORY / ".git").exists():
        pytest.skip("no git to say which files are ours")
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", *PACKAGES]
    ours = subprocess.run(command, cwd=REPOSITORY, check=True, capture_output=True, text=True)
    wanted = {
        name
        for name in ours.stdout.splitlines()
        if not any(re.fullmatch(pattern, name) for pattern in NOT_INSTALLED)
    }
    assert {name for name in files if ".dist-info/" not in name} == wanted
    assert {name.partition("/")[0] for name in files if ".dist-info/" not in name} == {*PACKAGES}


def test_whatever_is_imported_is_required_by_its_name(wheel: Path, metadata: RawMetadata):
    requirements = [Requirement(text) for text in metadata["requires_dist"]]
    required = {
        canonicalize_name(requirement.name)
        for requirement in requirements
        if any(applies(requirement, extra=extra) for extra in ("", *EXTRAS))
    }
    carriers = packages_distributions()
    foreign = imported(wheel) - {*PACKAGES, *sys.stdlib_module_names, *COMPANIONS}
    carried = {name: {canonicalize_name(each) for each in carriers[name]} for name in foreign}
    assert [name for name in sorted(foreign) if not required & carried[name]] == []


def imported(wheel: Path) -> set[str]:
    """The top-level names of all that the modules in a wheel import, wherever they do."""
    names: set[str] = set()
    with ZipFile(wheel) as archive:
        for file in archive.namelist():
            if not file.endswith(".py"):
                continue
            for node in ast.walk(ast.parse(archive.read(file))):
                if isinstance(node, ast.Import):
                    names |= {each.name.partition(".")[0] for each in node.names}
                elif isinstance(node, ast.ImportFrom):
                    assert node.level == 0, file
                    names.add(str(node.module).partition(".")[0])
    return names


def test_the_wheel_weighs_little(wheel: Path):
    assert wheel.stat().st_size <= MAX_WHEEL_BYTES


def test_a_source_distribution_gives_the_same_wheel(wheel: Path, tmp_path: Path):
    archive = built(REPOSITORY, "sdist", tmp_path / "sdist")
    source = tmp_path / "source"
    source.mkdir()
    command = ["tar", "--extract", "--strip-components=1", "--file", archive]
    subprocess.run([*command, "--directory", source], check=True)
    assert built(source, "wheel", tmp_path / "wheel").read_bytes() == wheel.read_bytes()


def test_it_has_the_version_of_the_service(metadata: RawMetadata):
    assert metadata["version"] == VERSION


def test_the_description_is_the_readme_without_what_only_the_repository_has(metadata: RawMetadata):
    text = metadata["description"]
    assert metadata["description_content_type"] == "text/markdown"
    assert text.startswith("# Maquette\n")
    assert "make demo" in text
    assert "![" not in text
    assert "[Accuracy](" in (REPOSITORY / "README.md").read_text()
    assert "\nAccuracy says" in text
    targets = re.findall(r"\]\(([^)]*)\)", text)
    assert all(target.startswith("https://") for target in targets)


def test_licences_of_all_that_is_inside_come_with_it(metadata: RawMetadata, files: set[str]):
    assert metadata["license_expression"] == "Apache-2.0 AND MIT AND OFL-1.1 AND CC0-1.0"
    of_the_page = (REPOSITORY / "service/page/dist/THIRD_PARTY.txt").read_text()
    assert "MIT License" in of_the_page
    assert "SIL OPEN FONT LICENSE" in of_the_page
    (folder,) = {name.partition("/")[0] for name in files if ".dist-info/" in name}
    assert {"LICENSE", "NOTICE", "service/page/dist/THIRD_PARTY.txt"} <= {
        *metadata["license_files"]
    }
    assert {f"{folder}/licenses/{name}" for name in metadata["license_files"]} <= files
