"""One body from several fits: what it is made of, and when it goes."""

import pytest

from tests.integration.service.harness import Service
from tests.integration.service.test_derivations import derived, fitted, post, problem


def test_fits_of_one_person_are_combined(either: Service):
    service = either
    one, other = fitted(service), fitted(service)
    body = {"kind": "combined", "fits": [other.rpartition("/")[2]]}
    job = service.ended(derived(service, one, body))
    assert job["state"] == "succeeded"
    result = service.client.get(job["links"]["result"]).json()
    assert (result["kind"], result["pictures"]) == ("combined", 2)


def test_a_fit_of_an_earlier_version_that_kept_less_is_not_combined(service: Service):
    fit, old = fitted(service), service.submit({"old": True})
    assert service.ended(old)["state"] == "succeeded"
    for one, other, field in ((fit, old, "fits.0"), (old, fit, "kind")):
        answer = post(service, one, {"kind": "combined", "fits": [other.rpartition("/")[2]]})
        assert problem(answer) == (422, "fits-unusable", field)
        assert f"The fit {old.rpartition('/')[2]} has no person.npz." in answer.text


@pytest.mark.parametrize("erased", [0, 1, 2])
def test_a_combined_body_goes_with_any_of_its_fits(service: Service, erased: int):
    fits = [fitted(service) for _ in range(3)]
    ids = [each.rpartition("/")[2] for each in fits]
    path = derived(service, fits[0], {"kind": "combined", "fits": ids[1:]})
    assert service.ended(path)["state"] == "succeeded"
    result = service.client.get(f"{path}/result").json()
    assert [each["fit_id"] for each in result["bodies"]] == ids
    again = service.client.post(f"{path}/retry").raise_for_status().headers["Location"]
    assert service.ended(again)["state"] == "succeeded"
    # Of one made of the first fit alone the others' ends are none of its business.
    alone = derived(service, fits[0], {"kind": "report"})
    service.ended(alone)
    assert service.client.delete(fits[erased]).status_code == 204
    for each in (path, again):
        assert service.client.get(each).status_code == 404
    assert service.client.get(alone).status_code == (404 if erased == 0 else 200)


def test_a_combined_body_ends_when_the_first_of_its_fits_does(service: Service):
    first, second = fitted(service), fitted(service)
    ends = [service.job(each)["expires_at"] for each in (first, second)]
    assert ends[0] < ends[1]
    for own, other in ((first, second), (second, first)):
        path = derived(service, own, {"kind": "combined", "fits": [other.rpartition("/")[2]]})
        assert service.job(path)["expires_at"] == ends[0]


def test_only_other_fits_that_have_succeeded_are_combined(service: Service):
    fit = fitted(service)
    own, unknown = fit.rpartition("/")[2], "00000000-0000-4000-8000-000000000000"
    failed = service.submit({"unusable": True})
    service.ended(failed)
    for other in (own, unknown, failed.rpartition("/")[2]):
        answer = post(service, fit, {"kind": "combined", "fits": [other]})
        assert answer.status_code == 422
        assert answer.json()["errors"][0]["field"] == "fits.0"
        assert other in answer.text
    for fits in ([], [own] * 2, [unknown] * 12):
        assert post(service, fit, {"kind": "combined", "fits": fits}).status_code == 422
