"""A derivation is made again of copies of all that the first was made of."""

from uuid import uuid4

from api_schemas.derivations import DerivationEvent
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import Service, eventually
from tests.integration.service.receiver import SECRET, Receiver
from tests.integration.service.test_derivations import (
    POSE,
    derived,
    fitted,
    post_motion,
    problem,
)
from tests.integration.service.test_own_textures import post_texture


def test_a_retry_makes_the_same_of_copies_of_all_that_went_in(either: Service):
    service = either
    fit = fitted(service)
    paths = [derived(service, fit)]
    painted = scripted_image(width=128, height=128)
    paths.append(post_texture(service, fit, painted).headers["Location"])
    paths.append(post_motion(service, fit).headers["Location"])
    first = [service.ended(path) for path in paths]
    results = [service.client.get(job["links"]["result"]).json() for job in first]
    # Each first job goes: its copies were its own.
    again = []
    for job in first:
        assert job["links"]["retry"] == f"{job['links']['self']}/retry"
        answer = service.client.post(job["links"]["retry"])
        assert answer.status_code == 202
        assert answer.json()["kind"] == job["kind"]
        again.append(answer.headers["Location"])
        assert again[-1].startswith(f"{fit}/derivations/")
        assert service.client.delete(job["links"]["self"]).status_code == 204
    for path, expected in zip(again, results, strict=True):
        job = service.ended(path)
        assert job["state"] == "succeeded"
        assert service.client.get(job["links"]["result"]).json() == expected
    assert set(again).isdisjoint(paths)


def test_a_derivation_that_has_not_ended_is_not_retried(service: Service):
    fit = fitted(service, {"seconds": 3600})
    path = derived(service, fit)
    assert service.job(path)["links"]["retry"] is None
    assert problem(service.client.post(f"{path}/retry"))[:2] == (409, "not-ended")
    service.client.post(f"{path}/cancel")
    canceled = service.ended(path)["links"]["retry"]
    unknown = f"{fit}/derivations/{uuid4()}/retry"
    assert service.client.post(unknown).status_code == 404
    assert service.client.post(f"{path.replace(fit, fitted(service))}/retry").status_code == 404
    assert service.client.post(canceled).status_code == 202
    # With what is derived from it.
    assert service.client.delete(fit).status_code == 204


def test_a_retry_of_a_derivation_is_asked_for_once_under_one_key_and_waited_for(service: Service):
    path = derived(service, fitted(service))
    service.ended(path)
    wishes = {"Idempotency-Key": "again", "Prefer": "wait=60"}
    one, same = (service.client.post(f"{path}/retry", headers=wishes) for _ in range(2))
    assert (one.status_code, one.json()["state"]) == (200, "succeeded")
    assert one.json()["id"] == same.json()["id"] != path.rpartition("/")[2]
    other = derived(service, path.partition("/derivations")[0])
    service.ended(other)
    refused = service.client.post(f"{other}/retry", headers=wishes)
    assert problem(refused)[:2] == (422, "idempotency-key-reused")


def test_the_end_of_a_retried_derivation_is_told_to_whom_the_first_one_s_was(
    service: Service, receiver: Receiver
):
    webhook = {"url": receiver.url(), "secret": SECRET}
    path = derived(service, fitted(service), POSE | {"webhook": webhook})
    service.ended(path)
    again = service.client.post(f"{path}/retry").headers["Location"]
    eventually(lambda: len(receiver.notices) >= 2, what="both ends are told")
    told = {DerivationEvent.model_validate_json(n.body).data.links.self for n in receiver.notices}
    assert told == {path, again}
    assert all(notice.is_signed_with(SECRET) for notice in receiver.notices)
