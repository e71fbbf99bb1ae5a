"""Several pictures of one person are one job, with all that a fit has."""

import hashlib
from pathlib import Path
from uuid import uuid4

import pytest

from api_schemas.scans import Scan, ScanOptions, ScanPage, ScanResult
from service.engine.database import open_database, prepare_database
from service.engine.keys import KeyRing
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.scanning import (
    FRONT,
    SCAN,
    SIDE,
    post_scan,
    scanned,
    submit_scan,
)
from tests.integration.service.test_images import uploaded


def test_two_pictures_are_sent_and_one_person_comes_out(either: Service):
    service = either
    images = [scripted_image({"n": 1}), scripted_image({"n": 2}, width=300, height=500)]
    request = SCAN | {
        "weight_kg": 80.5,
        "views": [FRONT, SIDE | {"points": {**SIDE["points"], "left_shoulder": [200.0, 90.0]}}],
    }
    request["views"][1]["points"] = {name: [0.4 * x, y] for name, (x, y) in SIDE["points"].items()}
    answer = post_scan(service, request=request, images=images)
    assert answer.status_code == 202, answer.text
    assert int(answer.headers["Retry-After"]) > 0
    accepted = Scan.model_validate_json(answer.content)
    path = answer.headers["Location"]
    assert accepted.links.self == path == f"/v1/scans/{accepted.id}"

    job = Scan.model_validate_json(service.client.get(path).content)
    assert job.links.derivations is None or job.state == "succeeded"
    ended = service.ended(path)
    assert (ended["state"], ended["progress"], ended["attempt"]) == ("succeeded", 1.0, 1)
    links = ended["links"]
    assert links["derivations"] == f"{path}/derivations"
    for view, image in zip(links["views"], images, strict=True):
        assert service.client.get(view["image"]).content == image
        assert view["mask"] is None
    understood = ScanOptions.model_validate_json(service.client.get(links["request"]).content)
    assert [each.view for each in understood.views] == ["front", "side"]
    assert understood.views[1].points["nose"].x == 128.0

    document = service.client.get(links["result"])
    result = ScanResult.model_validate_json(document.content)
    assert [(each.number, each.view) for each in result.views] == [(0, "front"), (1, "side")]
    assert [each.name for each in result.measurements if each.given] == ["weight"]
    names = {each.name for each in result.artifacts}
    assert {"body_canonical.glb", "body_posed_1.glb", "overlay_0.png", "person.npz"} <= names
    for artifact in result.artifacts:
        content = service.client.get(links["artifacts"][artifact.name]).content
        assert hashlib.sha256(content).hexdigest() == artifact.sha256
    table = service.client.get(f"{path}/artifacts/measurements.csv").text
    assert "weight,80.5,kg" in table


def test_the_pictures_may_have_been_uploaded_before(service: Service):
    images = [scripted_image({"uploaded": number}) for number in range(2)]
    ids = [uploaded(service, each).id for each in images]
    views = [{**view, "image_id": each} for view, each in zip((FRONT, SIDE), ids, strict=True)]
    views[1]["mask_id"] = ids[0]
    answer = service.client.post("/v1/scans", json=SCAN | {"views": views})
    assert answer.status_code == 202, answer.text
    job = service.ended(answer.headers["Location"])
    assert job["state"] == "succeeded"
    assert service.client.get(job["links"]["views"][1]["image"]).content == images[1]
    assert service.client.get(job["links"]["views"][1]["mask"]).content == images[0]


def test_scans_are_listed_by_themselves_and_found_nowhere_else(either: Service):
    service = either
    fit = service.submit()
    service.ended(fit)
    paths = [scanned(service) for _ in range(2)]
    page = ScanPage.model_validate_json(service.client.get("/v1/scans?limit=1").content)
    assert [each.links.self for each in page.scans] == [paths[1]]
    assert page.next is not None
    following = ScanPage.model_validate_json(service.client.get(page.next).content)
    assert following.scans[0].links.self == paths[0]
    assert service.client.get("/v1/fits?limit=1").json()["jobs"][0]["links"]["self"] == fit
    scan_id, fit_id = paths[0].rpartition("/")[2], fit.rpartition("/")[2]
    for wrong in (f"/v1/fits/{scan_id}", f"/v1/scans/{fit_id}", f"/v1/scans/{uuid4()}"):
        for below in ("", "/result", "/events", "/request", "/derivations"):
            assert service.client.get(wrong + below).status_code == 404
        assert service.client.delete(wrong).status_code == 404
        assert service.client.post(f"{wrong}/cancel").status_code == 404
    assert service.client.get(f"{paths[0]}/views/2/image").status_code == 404
    assert service.client.get(f"{paths[0]}/views/6/image").status_code == 422
    assert service.client.get(f"{paths[0]}/views/0/mask").status_code == 404


def test_a_scan_says_which_of_its_pictures_it_is_at(either: Service, tmp_path: Path):
    service, gate = either, tmp_path / "gate"
    path = submit_scan(service, {}, {"gate": str(gate)})
    at_second = eventually(
        lambda: (job := service.job(path))["view"] == 1 and job, what="the second picture"
    )
    assert (at_second["state"], at_second["stage"]) == ("running", "observation")
    gate.touch()
    assert service.ended(path)["view"] is None
    progress = [each["data"] for each in service.events(path) if each["event"] == "progress"]
    assert [each["view"] for each in progress] == [0, 1, None]
    assert [each["progress"] for each in progress] == sorted(each["progress"] for each in progress)


def test_a_scan_is_cancelled_between_its_pictures(either: Service, tmp_path: Path):
    service = either
    path = submit_scan(service, {}, {"gate": str(tmp_path / "never")})
    eventually(lambda: service.job(path)["view"] == 1, what="the second picture")
    assert service.client.post(f"{path}/cancel").status_code == 202
    job = service.ended(path)
    assert (job["state"], job["links"]["artifacts"]) == ("canceled", {})
    assert service.client.get(f"{path}/result").status_code == 409


def test_a_scan_is_repeated_with_copies_of_all_pictures(service: Service):
    images = [scripted_image({"again": number}) for number in range(3)]
    views = [FRONT, SIDE, {"view": "other", "points": FRONT["points"]}]
    first = scanned(service, request=SCAN | {"views": views}, images=images, masks={2: images[0]})
    answer = service.client.post(f"{first}/retry")
    assert answer.status_code == 202, answer.text
    again = answer.headers["Location"]
    assert service.ended(again)["state"] == "succeeded"
    assert service.client.delete(first).status_code == 204
    links = service.job(again)["links"]["views"]
    assert [service.client.get(each["image"]).content for each in links] == images
    assert service.client.get(links[2]["mask"]).content == images[0]


def test_a_scan_waits_as_so_many_jobs_as_it_has_pictures(tmp_path: Path):
    machine = Machine(tmp_path, settings={"max_queued": 3})
    with running_service(machine, api_only=True) as service:
        submit_scan(service)
        submit_scan(service)
        # Two scans are four pictures, more than three jobs.
        for refused in (post_scan(service), service.post()):
            assert (refused.status_code, refused.json()["code"]) == (503, "queue-full")


def test_every_view_counts_among_what_a_tenant_may_have_waiting(tmp_path: Path):
    settings = {"authentication": "keys", "max_queued_per_tenant": 3}
    machine = Machine(tmp_path, settings=settings)
    url = f"sqlite:///{tmp_path / 'maquette.sqlite'}"
    prepare_database(url)
    database = open_database(url)
    keys = [KeyRing(database).create(name) for name in ("somebody", "another")]
    database.dispose()
    with running_service(machine, api_only=True) as service:
        service.client.headers["Authorization"] = f"Bearer {keys[0]}"
        waiting = [submit_scan(service) for _ in range(2)]
        # Four pictures wait, more than three jobs: neither another scan nor a fit is taken.
        for refused in (post_scan(service), service.post()):
            assert (refused.status_code, refused.json()["code"]) == (429, "too-many-waiting")
        for path in waiting:
            assert service.client.delete(path).status_code == 204
        submit_scan(service)
        service.client.headers["Authorization"] = f"Bearer {keys[1]}"
        submit_scan(service)


@pytest.mark.parametrize(
    "asked",
    [
        {"kind": "caricature", "factor": 2.0},
        {"kind": "pose", "pose": "standing"},
        {"kind": "texture"},
        {"kind": "animation"},
        {"kind": "body_composition", "age_years": 40},
        {"kind": "size", "chart_csv": "size,chest_girth\nM,94-98\nL,98-102\n"},
    ],
    ids=lambda asked: asked["kind"],
)
def test_of_a_scan_is_derived_what_the_person_is_enough_for(service: Service, asked):
    path = scanned(service)
    answer = service.client.post(f"{path}/derivations", json=asked)
    assert answer.status_code == 202, answer.text
    derivation = answer.headers["Location"]
    assert derivation.startswith(f"{path}/derivations/")
    job = service.ended(derivation)
    assert job["state"] == "succeeded"
    assert (job["scan_id"], job["links"]["scan"]) == (path.rpartition("/")[2], path)
    assert service.client.get(job["links"]["result"]).json()["kind"] == asked["kind"]
    listed = service.client.get(f"{path}/derivations").json()["derivations"]
    assert [each["id"] for each in listed] == [job["id"]]
    fits = f"/v1/fits/{job['scan_id']}/derivations/{job['id']}"
    assert service.client.get(fits).status_code == 404


def test_how_long_scans_ran_is_counted_by_itself(service: Service):
    scanned(service)
    figures = service.client.get("/metrics").text
    assert 'phase="running.scan"' in figures
