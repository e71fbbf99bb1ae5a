"""Fits by person: labelled, listed, erased, each tenant's for itself."""

from typing import Any
from uuid import uuid4

import pytest

from service.jobs.engine import JobEngine
from service.jobs.records import FIT, NewJob, StoredBlob, SubmitOutcome
from tests.integration.service.harness import REQUEST, Machine, Service
from tests.integration.service.test_bad_input import checked
from tests.integration.service.test_images import engine_of


def name() -> str:
    """A label that no other test has, with what addresses must escape."""
    return f"Zoë & 山田 100% #{uuid4().hex[:8]}"


def fit(service: Service, label: str | None) -> str:
    answer = service.post(request={**REQUEST, "label": label})
    assert answer.status_code == 202, answer.text
    assert answer.json()["label"] == label
    return answer.headers["Location"]


def listed(service: Service, label: str, **query: Any) -> list[str]:
    """Paths of all jobs of a label, over all pages."""
    page = service.client.get("/v1/fits", params={"label": label, **query}).json()
    found = []
    while True:
        jobs = page["fits"]
        assert {job["label"] for job in jobs} <= {label}
        found += [job["links"]["self"] for job in jobs]
        if page["next"] is None:
            return found
        page = service.client.get(page["next"]).json()


def test_fits_are_listed_by_label(either: Service):
    service = either
    anna, ben = name(), name()
    fits = [fit(service, label) for label in (anna, ben, None, anna, anna)]
    assert listed(service, anna, limit=1) == [fits[4], fits[3], fits[0]]
    assert listed(service, ben) == [fits[1]]
    assert listed(service, anna[:-1]) == []
    assert listed(service, anna.upper()) == []
    for path in fits:
        assert service.ended(path)["state"] == "succeeded"
    assert len(listed(service, anna, state="succeeded", limit=2)) == 3
    assert listed(service, anna, state="failed") == []
    assert service.job(fits[2])["label"] is None
    assert service.client.delete(fits[1]).status_code == 204
    assert listed(service, ben) == []


@pytest.mark.parametrize("label", ["x" * 81, "two\nlines"])
def test_a_label_that_cannot_be_is_refused_wherever_it_is_sent(service: Service, label):
    problem = checked(service.client.get("/v1/fits", params={"label": label}), 422)
    assert problem.field == "label"
    assert problem.code in ("wrong-length", "unreadable-label")
    assert checked(service.post(request={**REQUEST, "label": label}), 422).field == "label"


def accept(engine: JobEngine, tenant: str, job_id: str, label: str) -> None:
    blob = StoredBlob(digest="0" * 64, media_type="application/json")
    jobs = engine.of(tenant)
    jobs.submissions.reserve(job_id, None)
    job = NewJob(id=job_id, kind=FIT, options=blob, inputs={}, label=label)
    assert jobs.submissions.submit(job).outcome is SubmitOutcome.ACCEPTED


def test_a_tenant_sees_its_own_labels_alone(machine: Machine):
    engine = engine_of(machine)
    try:
        accept(engine, "ours", "1", "Anna")
        accept(engine, "theirs", "2", "Anna")
        ours = engine.of("ours").jobs(limit=9, before=None, state=None, label="Anna")
        assert [job.id for job in ours] == ["1"]
    finally:
        engine.close()
