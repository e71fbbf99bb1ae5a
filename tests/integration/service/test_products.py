"""Products of a fit: made once of what is asked for, kept in the fit's own storage."""

import json
from pathlib import Path
from typing import Any
from uuid import uuid4

import httpx
import pytest

from api_schemas.products import Product
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    is_running,
    pids_noted,
    running_service,
)

POSE = {"kind": "pose"}
CHART = "size,chest_girth,waist_girth_navel\nM,94-98,80-84\nL,98-102,84-88\n"
MOTIONS = Path(__file__).parents[2] / "unit" / "applications" / "data" / "bvh"
BVH = (MOTIONS / "r_identity.bvh").read_text(encoding="ascii")
"""Five seconds of a walk."""


def fitted(service: Service, product: dict[str, object] | None = None) -> str:
    """Have a fit made whose products do as the script says, and return its path."""
    path = service.submit({"product": product or {}, "of": uuid4().hex})
    assert service.ended(path)["state"] == "succeeded"
    return path


@pytest.fixture(scope="module")
def succeeded(service: Service) -> str:
    """The path of a fit of which nothing is made."""
    return fitted(service)


def post(service: Service, fit: str, body: object = POSE, **headers: str) -> httpx.Response:
    return service.client.post(f"{fit}/products", json=body, headers=headers)


def made(service: Service, fit: str, body: object = POSE) -> dict[str, Any]:
    """Have a product made of a fit, and return it once that has ended."""
    answer = post(service, fit, body)
    assert answer.status_code in (200, 202), answer.text
    return service.ended(answer.headers["Location"])


def form(
    service: Service, fit: str, request: object, **parts: tuple[str, str | bytes]
) -> httpx.Response:
    return service.client.post(
        f"{fit}/products", data={"request": json.dumps(request)}, files=parts
    )


def fault(answer: httpx.Response) -> tuple[int, str, str | None]:
    body = answer.json()
    return answer.status_code, body["code"], body["field"]


def test_a_product_is_asked_for_and_its_files_come_out(either: Service):
    service = either
    fit = fitted(service)
    assert service.job(fit)["links"]["products"] == f"{fit}/products"
    answer = post(service, fit)
    assert answer.status_code == 202
    assert int(answer.headers["Retry-After"]) > 0
    accepted = Product.model_validate_json(answer.content)
    path = answer.headers["Location"]
    assert accepted.links.self == path == f"{fit}/products/{accepted.id}"
    assert (accepted.links.fit, accepted.links.files, accepted.result) == (fit, {}, None)
    product = service.ended(path)
    assert (product["state"], product["progress"], product["kind"]) == ("succeeded", 1.0, "pose")
    assert product["result"] == {"kind": "pose", "pose": {}, "colours": "plain"}
    assert set(product["links"]["files"]) == {"body_reposed.glb", "pose.png"}
    glb = service.client.get(product["links"]["files"]["body_reposed.glb"])
    assert (glb.headers["content-type"], glb.content[:4]) == ("model/gltf-binary", b"glTF")
    for missing in ("nothing.png", "result.json", "measurements.csv"):
        assert service.client.get(f"{path}/files/{missing}").status_code == 404
    assert "/products/" not in service.client.get("/v1/fits").text.replace(f"{fit}/products", "")


def test_the_same_options_are_the_same_product_and_it_is_made_once(either: Service, tmp_path: Path):
    note = tmp_path / "pids"
    fit = fitted(either, {"note_pid": str(note)})
    asked = {"kind": "caricature", "factor": 2}
    first = made(either, fit, asked)
    again = post(either, fit, {"kind": "caricature", "factor": 2.0, "exaggerated": "coefficient"})
    assert again.status_code == 200
    assert again.json() == first
    other = made(either, fit, {"kind": "caricature", "factor": 3})
    assert other["id"] != first["id"]
    assert len(pids_noted(note)) == 2
    elsewhere = fitted(either)
    assert made(either, elsewhere, asked)["id"] == first["id"]


def test_a_product_is_found_below_its_own_fit_alone(service: Service):
    one, other = fitted(service), fitted(service)
    product = made(service, one)
    for wrong in (f"{other}/products/{product['id']}", f"/v1/fits/{uuid4()}/products/x"):
        assert service.client.get(wrong).status_code in (404, 422)
    wrong = f"{other}/products/{product['id']}/files/pose.png"
    assert service.client.get(wrong).status_code == 404


def test_nothing_is_made_of_a_fit_that_has_not_succeeded(service: Service):
    waiting = service.submit({"seconds": 3600})
    assert fault(post(service, waiting))[:2] == (409, "no-result")
    service.client.delete(waiting)
    failed = service.submit({"unusable": True})
    service.ended(failed)
    assert fault(post(service, failed))[:2] == (409, "image-truncated")
    assert service.job(failed)["links"]["products"] is None
    assert post(service, f"/v1/fits/{uuid4()}").status_code == 404


@pytest.mark.parametrize(
    ("body", "status", "code", "field"),
    [
        ({}, 422, "unknown-value", "kind"),
        ({"kind": "pose", "pages": 2}, 422, "unknown-field", "pages"),
        ({"kind": "caricature", "factor": -1}, 422, "out-of-range", "factor"),
        ({"kind": "animation", "up": "y"}, 422, "missing", "bvh"),
        ({"kind": "size"}, 422, "missing", "chart"),
    ],
)
def test_a_request_at_fault_is_refused_with_the_field(
    service: Service, succeeded: str, body: object, status: int, code: str, field: str
):
    assert fault(post(service, succeeded, body)) == (status, code, field)


def test_a_file_comes_along_and_another_one_is_another_product(service: Service):
    fit = fitted(service)
    asked = {"kind": "animation", "start_s": 1}
    moved = service.ended(form(service, fit, asked, bvh=("m.bvh", BVH)).headers["Location"])
    assert moved["result"]["source"] == BVH[:40]
    other = form(service, fit, asked, bvh=("m.bvh", BVH + "\n")).headers["Location"]
    walk = made(service, fit, asked)
    assert len({moved["id"], other.rpartition("/")[2], walk["id"]}) == 3
    assert walk["result"]["source"] == "a walk"


@pytest.mark.parametrize(
    ("request_", "part", "content", "expected"),
    [
        ({"kind": "pose"}, "bvh", BVH, (422, "unknown-field", "bvh")),
        ({"kind": "animation"}, "bvh", "HIERARCHY", (422, "bvh-unreadable", "bvh")),
        ({"kind": "size"}, "chart", "size,waist\nM,80-84\n", (422, "not-a-chart", "chart")),
        (
            {"kind": "size", "ease": {"hip_girth": 1}},
            "chart",
            CHART,
            (422, "unknown-value", "ease.hip_girth"),
        ),
    ],
)
def test_a_file_at_fault_is_refused_before_anything_is_made(
    service: Service,
    succeeded: str,
    request_: object,
    part: str,
    content: str | bytes,
    expected: tuple,
):
    assert fault(form(service, succeeded, request_, **{part: ("file", content)})) == expected


@pytest.mark.parametrize(
    ("script", "code"),
    [
        ({"fault": True}, "fit-failed"),
        ({"segfault": True}, "fit-crashed"),
    ],
)
def test_a_product_that_fails_says_why_and_is_begun_anew_when_it_is_asked_for_again(
    service: Service, tmp_path: Path, script: dict, code: str
):
    note = tmp_path / "pids"
    fit = fitted(service, script | {"note_pid": str(note)})
    first = made(service, fit)
    assert (first["state"], first["problem"]["code"]) == ("failed", code)
    before = len(pids_noted(note))
    again = post(service, fit)
    assert again.status_code == 202
    assert again.json()["id"] == first["id"]
    assert service.ended(again.headers["Location"])["problem"]["code"] == code
    assert len(pids_noted(note)) == 2 * before


def test_a_product_that_failed_for_its_options_names_them_and_stays_so(service: Service):
    fit = fitted(service)
    asked = {"kind": "caricature", "factor": 7}
    first = made(service, fit, asked)
    (error,) = first["problem"]["errors"]
    assert (first["state"], error["field"], error["largest"]) == ("failed", "factor", 6.0)
    again = post(service, fit, asked)
    assert (again.status_code, again.json()) == (200, first)


def test_erasing_a_fit_stops_its_products_and_keeps_nothing(either: Service, tmp_path: Path):
    service = either
    note = tmp_path / "pids"
    fit = fitted(service, {"seconds": 3600, "burn": True, "note_pid": str(note)})
    paths = [
        post(service, fit, {"kind": kind}).headers["Location"] for kind in ("pose", "composition")
    ]
    pids = eventually(lambda: pids_noted(note), what="a product is being made")
    assert service.client.delete(fit).status_code == 204
    for path in paths:
        assert service.client.get(path).status_code == 404
    eventually(lambda: not any(map(is_running, pids)), what="the processes are gone")
    blobs = service.machine.data_dir / "blobs"
    scope = Path(fit).name
    eventually(
        lambda: scope not in {each.name for each in blobs.rglob("*")}, what="the blobs are gone"
    )


def test_products_that_wait_count_among_the_jobs_of_the_queue(tmp_path: Path):
    machine = Machine(tmp_path, settings={"max_queued": 2, "worker_processes": 1})
    with running_service(machine) as service:
        fit = fitted(service, {"seconds": 3600})
        factors = iter(range(1, 9))

        def ask() -> httpx.Response:
            return post(service, fit, {"kind": "caricature", "factor": next(factors)})

        first = ask().headers["Location"]
        eventually(lambda: service.state(first) == "running", what="the first runs")
        assert [ask().status_code, ask().status_code] == [202, 202]
        assert fault(ask())[:2] == (503, "queue-full")
        assert fault(service.post())[:2] == (503, "queue-full")
        # What is there is answered all the same.
        assert post(service, fit, {"kind": "caricature", "factor": 1}).status_code == 202
        # Else the service, told to stop, would wait for what runs.
        assert service.client.delete(fit).status_code == 204


def test_a_mesh_is_had_in_other_formats_too(service: Service):
    files = made(service, fitted(service))["links"]["files"]
    for ending in ("obj", "stl"):
        mesh = service.client.get(files["body_reposed.glb"].replace("glb", ending))
        assert mesh.content.startswith(f"{ending} of".encode())
