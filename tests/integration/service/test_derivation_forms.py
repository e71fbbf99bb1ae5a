"""Requests for derivations that bring a motion along, as forms."""

from service.api.derivation_kinds.animation import MAX_CLIP_BYTES
from tests.integration.service.harness import Service
from tests.integration.service.test_derivations import BVH, fitted, post_motion, problem


def test_the_same_key_with_another_motion_is_refused(service: Service):
    fit = fitted(service)
    key = {"headers": {"Idempotency-Key": "motion-1"}}
    assert post_motion(service, fit, **key).status_code == 202
    assert problem(post_motion(service, fit, BVH + "\n", **key))[1] == "idempotency-key-reused"


def test_a_form_at_fault_is_refused_with_the_part(service: Service):
    fit = fitted(service)
    for clip in ("", "motion", '{"kind": "animation"}'):
        assert problem(post_motion(service, fit, clip)) == (422, "not-a-bvh", "bvh")
    assert post_motion(service, fit, "\ufeff\n hierarchy\n").status_code == 202
    report = {"data": {"request": '{"kind": "report"}'}}
    assert problem(post_motion(service, fit, **report)) == (422, "unknown-field", "bvh")
    assert problem(post_motion(service, fit, data={})) == (422, "missing", "request")
    extra = {"data": {"request": '{"kind": "animation"}', "mask": "x"}}
    assert problem(post_motion(service, fit, **extra)) == (422, "unknown-field", "mask")
    broken = {"data": {"request": '{"kind"'}}
    assert problem(post_motion(service, fit, **broken)) == (400, "invalid-json", "request")


def test_a_motion_that_is_too_large_is_refused(service: Service):
    large = BVH + " " * MAX_CLIP_BYTES
    assert problem(post_motion(service, fitted(service), large)) == (
        413,
        "payload-too-large",
        "bvh",
    )
