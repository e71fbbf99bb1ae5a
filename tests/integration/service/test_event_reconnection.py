"""Who reconnects to a job's events misses none, and is sent away once there are no more."""

import pytest

from tests.integration.service.harness import Service, eventually

FAR = 10**40
"""No database holds such a number."""


def status_after(service: Service, path: str, event: object) -> int:
    """The status of the answer to a reconnection; an endless stream is not waited for."""
    headers = {"Last-Event-ID": str(event)}
    with service.client.stream("GET", f"{path}/events", headers=headers) as answer:
        return answer.status_code


@pytest.fixture(scope="module")
def ended(service: Service) -> str:
    """The path of a fit that has ended."""
    path = service.submit()
    service.ended(path)
    return path


def test_after_the_end_there_is_nothing_to_reconnect_to(service: Service, ended: str):
    last = int(service.events(ended)[-1]["id"])
    for event in (last, last + 1, FAR):
        assert status_after(service, ended, event) == 204, event


def test_who_was_away_at_the_end_is_told_the_rest(service: Service, ended: str):
    events = service.events(ended)
    for seen in (0, 1, len(events) - 1):
        assert service.events(ended, after=seen) == events[seen:]


@pytest.mark.parametrize("event", ["", "later", "-1", "1.5", "1e3", "²"])
def test_what_never_was_an_event_is_refused_by_name(service: Service, ended: str, event: str):
    headers = {b"Last-Event-ID": event.encode()}
    answer = service.client.get(f"{ended}/events", headers=headers)
    assert (answer.status_code, answer.json()["field"]) == (422, "last-event-id")


def test_a_number_beyond_all_events_has_the_rest_of_a_running_job_told(service: Service):
    path = service.submit({"seconds": 60, "burn": True})
    eventually(lambda: service.state(path) == "running", what="the fit runs")
    seen = service.job(path)
    headers = {"Last-Event-ID": str(FAR)}
    with service.client.stream("GET", f"{path}/events", headers=headers) as answer:
        assert answer.status_code == 200
        service.client.post(f"{path}/cancel")
        told = "".join(answer.iter_text())
    assert seen["state"] == "running"
    assert "event: end" in told
    assert '"state":"canceled"' in told
    assert '"state":"queued"' not in told
