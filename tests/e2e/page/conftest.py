from collections.abc import Iterator

import httpx
import pytest
from playwright.sync_api import Browser, expect, sync_playwright

from service.demo_sample import load_sample
from tests.e2e.page.browser import chromium
from tests.e2e.page.visitor import Visitor
from tests.e2e.service import ended_job, running_service, wait_for_estimator

expect.set_options(timeout=30_000)
"""For machines that are busy; what is there is not waited for."""


@pytest.fixture(scope="package")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """One real service for all tests of the page."""
    with running_service(tmp_path_factory.mktemp("service")) as client:
        wait_for_estimator(client)
        yield client


@pytest.fixture(scope="package")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright, chromium(playwright) as running:
        yield running


@pytest.fixture
def visitor(browser: Browser, service: httpx.Client) -> Iterator[Visitor]:
    """Someone at a desk, with the page before them; nothing may have gone wrong at the end."""
    with Visitor.at(browser, str(service.base_url)) as someone:
        yield someone


@pytest.fixture(scope="package")
def finished_fit(service: httpx.Client) -> str:
    """The id of a fit of the sample that has succeeded."""
    sample = load_sample()
    files = {
        "image": ("sample.jpg", sample.image, "image/jpeg"),
        "request": ("request.json", sample.request, "application/json"),
    }
    job = ended_job(service, service.post("/v1/fits", files=files))
    assert job["state"] == "succeeded"
    return job["id"]
