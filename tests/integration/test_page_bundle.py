"""The committed bundle of the page is what its sources give, and its sources agree with the API."""

import re
import subprocess
from pathlib import Path

import pytest

from tests.external_tools import installed

REPOSITORY = Path(__file__).parents[2]
PAGE = REPOSITORY / "service" / "page"
MAX_GZIPPED_BYTES = 300_000
WEIGHED = re.compile(r"(\d+) bytes gzipped before a first result")


@pytest.fixture(scope="module")
def page() -> Path:
    return installed(PAGE)


def run(page: Path, *command: str) -> str:
    done = subprocess.run(command, cwd=page, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def bundle(page: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """What the sources give, and what is printed of it."""
    folder = tmp_path_factory.mktemp("bundle") / "dist"
    return folder, run(page, "node", "build.mjs", str(folder))


def content_of(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in folder.iterdir()}


def test_the_committed_bundle_is_built_from_the_sources(bundle: tuple[Path, str]):
    built, committed = content_of(bundle[0]), content_of(PAGE / "dist")
    assert sorted(built) == sorted(committed), "run `npm run build` in service/page"
    assert built == committed, "run `npm run build` in service/page"


def test_the_sources_agree_with_the_types_of_the_exported_api(page: Path):
    run(page, "npm", "run", "--silent", "check")


def test_modules_of_the_page_do_what_their_tests_say(page: Path):
    run(page, "npm", "run", "--silent", "test")


def test_the_page_weighs_little_until_there_is_a_result(bundle: tuple[Path, str]):
    _, printed = bundle
    assert 100_000 < int(WEIGHED.search(printed)[1]) <= MAX_GZIPPED_BYTES, printed


def test_licences_of_all_that_is_bundled_lie_beside_it():
    text = (PAGE / "dist" / "THIRD_PARTY.txt").read_text()
    for name in ("preact", "@preact/signals", "three", "ibm-plex-sans"):
        assert name in text


def test_the_lock_names_no_registry():
    assert '"resolved"' not in (PAGE / "package-lock.json").read_text()
