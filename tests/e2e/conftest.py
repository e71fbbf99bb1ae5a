from collections.abc import Iterator

import httpx
import pytest

from service.demo_data.sample import load_sample
from tests.e2e.service import ended_job, running_service, wait_for_estimator


@pytest.fixture(scope="package")
def service(tmp_path_factory: pytest.TempPathFactory) -> Iterator[httpx.Client]:
    """One real service for all tests of a process; other tests' fits may be there."""
    with running_service(tmp_path_factory.mktemp("service")) as client:
        wait_for_estimator(client)
        yield client


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
