"""Requests for derivations that bring a motion along, as forms."""

import json

import pytest

from fitter.applications.bvh import MAX_BYTES
from tests.integration.service.harness import Service
from tests.integration.service.test_derivations import BVH, fitted, post, post_motion, problem


def test_the_same_key_with_another_motion_is_refused(service: Service):
    fit = fitted(service)
    key = {"headers": {"Idempotency-Key": "motion-1"}}
    assert post_motion(service, fit, **key).status_code == 202
    assert problem(post_motion(service, fit, BVH + "\n", **key))[1] == "idempotency-key-reused"


def test_a_form_at_fault_is_refused_with_the_part(service: Service):
    fit = fitted(service)
    for clip in ("", "motion", '{"kind": "animation"}'):
        assert problem(post_motion(service, fit, clip)) == (422, "not-a-bvh", "bvh")
    assert post_motion(service, fit, "\ufeff" + BVH).status_code == 202
    report = {"data": {"request": '{"kind": "pose"}'}}
    assert problem(post_motion(service, fit, **report)) == (422, "unknown-field", "bvh")
    assert problem(post_motion(service, fit, data={})) == (422, "missing", "request")
    extra = {"data": {"request": '{"kind": "animation"}', "mask": "x"}}
    assert problem(post_motion(service, fit, **extra)) == (422, "unknown-field", "mask")
    broken = {"data": {"request": '{"kind"'}}
    assert problem(post_motion(service, fit, **broken)) == (400, "invalid-json", "request")


def test_a_motion_that_is_too_large_is_refused(service: Service):
    large = BVH + " " * MAX_BYTES
    assert problem(post_motion(service, fitted(service), large)) == (
        413,
        "payload-too-large",
        "bvh",
    )


FRAMES, _, LAST_FRAME = BVH.rstrip().rpartition("\n")
FAR = f"{FRAMES}\n1e6 {LAST_FRAME.split(maxsplit=1)[1]}\n"
"""The same, but that the hips leave for another unit."""


@pytest.mark.parametrize(
    ("clip", "asked", "code", "field"),
    [
        (BVH[:5000], {}, "bvh-unreadable", "bvh"),
        (BVH.replace("Frames: 40", "Frames: 42"), {}, "bvh-unreadable", "bvh"),
        (BVH.replace("Frames: 40", "Frames: 4000000"), {}, "bvh-too-long", "bvh"),
        (BVH.replace("LeftKnee", "Peg"), {}, "bvh-skeleton-unknown", "bvh"),
        (BVH, {"joints": {"left_shin": "Peg"}}, "bvh-skeleton-unknown", "joints.left_shin"),
        (BVH, {"joints": {"tail": "Hips"}}, "part-unknown", "joints.tail"),
        (FAR, {}, "bvh-too-far", "bvh"),
        (BVH, {"start_s": 6.0}, "stretch-outside-clip", "start_s"),
        (BVH, {"up": "w"}, "unknown-value", "up"),
    ],
)
def test_what_is_refused_of_a_motion_is_refused_before_it_waits(
    service: Service, clip: str, asked: dict[str, object], code: str, field: str
):
    fit = fitted(service)
    request = {"data": {"request": json.dumps({"kind": "animation", **asked})}}
    assert problem(post_motion(service, fit, clip, **request)) == (422, code, field)
    assert service.client.get(f"{fit}/derivations").json()["derivations"] == []


def test_joints_that_a_program_names_otherwise_are_told_by_the_request(service: Service):
    asked = {"kind": "animation", "joints": {"left_shin": "Peg"}, "up": "y"}
    request = {"data": {"request": json.dumps(asked)}}
    clip = BVH.replace("LeftKnee", "Peg")
    assert post_motion(service, fitted(service), clip, **request).status_code == 202


@pytest.mark.parametrize("asked", [{"up": "y"}, {"joints": {"pelvis": "Hips"}}])
def test_what_is_said_of_a_file_needs_the_file(service: Service, asked: dict[str, object]):
    answer = post(service, fitted(service), {"kind": "animation", **asked})
    assert problem(answer) == (422, "missing", "bvh")
