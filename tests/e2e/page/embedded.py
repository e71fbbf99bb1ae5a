"""The page as a part of another site, and somebody who visits that."""

import contextlib
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest
import sqlalchemy as sa
from playwright.sync_api import Browser, Frame, FrameLocator, Page, expect

from service.demo_data import sample
from service.engine.database import open_database
from service.engine.tables import BROWSER_TOKENS
from tests.e2e.page.embedding import Site, documented, documented_token_maker, serving
from tests.e2e.page.visitor import DESK, GIVEN_UP_AFTER_MS, SETTLED, VIOLATIONS
from tests.e2e.service import READY_WITHIN_S, REPOSITORY, running_service, wait_for_estimator

DATA = Path(sample.__file__).parent
FITS = """() => {
  const { scrollHeight, scrollWidth } = document.documentElement;
  return scrollHeight <= innerHeight && scrollWidth <= innerWidth;
}"""


@dataclass
class Embedding:
    """The service; a site, one on the service's own host, and one that it does not know."""

    site: Site
    neighbour: Site
    stranger: Site
    service: httpx.Client
    data_dir: Path
    key: str

    def expire(self, token: str) -> None:
        """Let the time of a token be over, and the service know it."""
        database = open_database(f"sqlite:///{self.data_dir / 'maquette.sqlite'}")
        with database.begin() as connection:
            connection.execute(
                sa.update(BROWSER_TOKENS)
                .where(BROWSER_TOKENS.c.id == token.split("_")[1])
                .values(expires_at=time.time())
            )
        database.dispose()
        deadline = time.monotonic() + READY_WITHIN_S
        headers = {"Authorization": f"Bearer {token}"}
        while (
            self.service.get("/v1/scans", headers=headers).status_code != httpx.codes.UNAUTHORIZED
        ):
            assert time.monotonic() < deadline
            time.sleep(0.1)


@pytest.fixture(scope="module")
def embedding(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Embedding]:
    data_dir = tmp_path_factory.mktemp("embedding")
    with (
        # Another host than that of the service, so that browsers take them for two sites.
        serving("localhost") as site,
        serving("127.0.0.1") as neighbour,
        serving("localhost") as stranger,
        pytest.MonkeyPatch.context() as environment,
    ):
        environment.setenv("MAQUETTE_AUTHENTICATION", "keys")
        environment.setenv("MAQUETTE_EMBED_ORIGINS", f"{site.origin},{neighbour.origin}")
        environment.setenv("MAQUETTE_DATA_DIR", str(data_dir))
        with running_service(data_dir) as service:
            command = [sys.executable, "-m", "service.cli", "keys", "create", "shop"]
            made = subprocess.run(
                command, cwd=REPOSITORY, capture_output=True, text=True, check=True
            )
            key = made.stdout.strip()
            service.headers["Authorization"] = f"Bearer {key}"
            wait_for_estimator(service)
            address = str(service.base_url).rstrip("/")
            environment.setenv("SERVICE", address)
            environment.setenv("KEY", key)
            for each in (site, neighbour, stranger):
                each.make_token = documented_token_maker()
                each.pages["/"] = documented("page", address)
                each.pages["/de"] = each.pages["/"].replace('lang="en"', 'lang="de"')
                each.pages["/messages"] = documented("messages", address)
            yield Embedding(site, neighbour, stranger, service, data_dir, key)


@contextlib.contextmanager
def at(
    browser: Browser, address: str, device: dict[str, Any] = DESK, **options: Any
) -> Iterator[Page]:
    """Somebody at a page of the site; at the end nothing may have gone wrong."""
    context = browser.new_context(**(SETTLED | device | options))
    context.set_default_timeout(GIVEN_UP_AFTER_MS)
    context.add_init_script(VIOLATIONS)
    page = context.new_page()
    complaints: list[str] = []
    page.on("pageerror", lambda error: complaints.append(str(error)))
    try:
        page.goto(address)
        yield page
        assert complaints == []
        for frame in page.frames:
            assert frame.evaluate("window.violations ?? []") == []
    finally:
        context.close()


def begin(page: Page) -> FrameLocator:
    """Give the site the sample pair and let it show the frame."""
    for name in ("front", "side"):
        page.locator(f"#{name}").set_input_files(DATA / f"scan_{name}.jpg")
    page.get_by_role("button", name="Measure me").click()
    return page.frame_locator("iframe")


def own_frame(page: Page) -> Frame:
    (frame,) = (each for each in page.frames if each.url.endswith("#/embed"))
    return frame


def wait_for_checks(frame: FrameLocator) -> None:
    """Wait until the service has found both pictures good."""
    for name in ("front", "side"):
        expect(frame.locator(f'[data-place="{name}"] .place-good')).to_be_visible()


def fits_into_its_frame(page: Page) -> None:
    """Wait until nothing has to be scrolled within the frame; nor does the site's page run over."""
    own_frame(page).wait_for_function(FITS)
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
