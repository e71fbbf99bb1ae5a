"""A fit's files: its pictures and request, meshes in other formats, measurements as tables."""

import csv
import hashlib
import io
import json

import httpx
import pytest

from api_schemas.fit import FitRequest
from tests.integration.service.fake_answers import GLB as GLB_CONTENT
from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    POINTS,
    REQUEST,
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.test_bad_input import checked


def test_picture_and_request_of_a_job_can_be_had_again(service: Service):
    job = service.client.get(service.submit()).json()
    picture = service.client.get(job["links"]["files"]["views/0/image"])
    assert picture.content == scripted_image()
    assert picture.headers["content-type"] == "image/png"
    request = service.client.get(job["links"]["request"])
    options = FitRequest.model_validate_json(request.content)
    assert options.height_m == REQUEST["height_m"]
    assert set(json.loads(request.content)["views"][0]["points"]) == set(POINTS)


def test_a_picture_can_be_had_as_a_jpeg(service: Service):
    wait_for_estimator(service)
    link = service.client.get(service.submit()).json()["links"]["files"]["views/0/image"]
    sent = service.client.get(link)
    shown = service.client.get(link, headers={"Accept": "image/jpeg"})
    assert shown.headers["content-type"] == "image/jpeg"
    assert shown.content.startswith(f"JPEG of {len(scripted_image())} bytes".encode())
    assert shown.headers["vary"] == sent.headers["vary"] == "Accept"
    assert shown.headers["etag"] != sent.headers["etag"]
    known = {"Accept": "image/jpeg", "If-None-Match": shown.headers["etag"]}
    assert service.client.get(link, headers=known).status_code == 304
    other = {"Accept": "image/jpeg", "If-None-Match": sent.headers["etag"]}
    assert service.client.get(link, headers=other).status_code == 200


@pytest.mark.parametrize("accept", ["application/json", "image/jpeg;q=0.5, image/png"])
def test_who_does_not_prefer_a_jpeg_gets_the_picture_as_it_was_sent(service: Service, accept):
    link = service.client.get(service.submit()).json()["links"]["files"]["views/0/image"]
    answer = service.client.get(link, headers={"Accept": accept})
    assert (answer.headers["content-type"], answer.content) == ("image/png", scripted_image())


def test_they_are_not_sent_twice_to_who_has_them(service: Service):
    links = service.client.get(service.submit()).json()["links"]
    for link in (links["files"]["views/0/image"], links["request"]):
        tag = service.client.get(link).headers["etag"]
        again = service.client.get(link, headers={"If-None-Match": tag})
        assert (again.status_code, again.content) == (304, b"")


BROWSER = "text/html,application/xhtml+xml,application/xml;q=0.9,image/avif,image/webp,*/*;q=0.8"
MESH_TYPES = {
    "obj": "model/obj",
    "ply": "model/ply",
    "stl": "model/stl",
}
GLB = "model/gltf-binary"
GLB_BYTES = 260
"""Of the mesh of a pretended fit."""


@pytest.fixture(scope="module")
def files(service: Service) -> str:
    """Where the files of a fit lie."""
    wait_for_estimator(service)
    return f"{service.fitted()}/files"


def wait_for_estimator(service: Service) -> None:
    eventually(
        lambda: service.client.post("/v1/bodies", json={"gender": "male"}).status_code == 200,
        what="the estimator answers",
    )


def get(service: Service, path: str, **headers: str) -> httpx.Response:
    return service.client.get(
        path, headers={name.replace("_", "-"): value for name, value in headers.items()}
    )


@pytest.mark.parametrize(("ending", "media_type"), MESH_TYPES.items())
def test_a_mesh_is_had_in_another_format_by_its_name(service: Service, files, ending, media_type):
    answer = get(service, f"{files}/body_canonical.{ending}", Accept="image/png")
    assert answer.status_code == 200
    assert answer.headers["content-type"] == media_type
    assert answer.content == f"{ending} of {GLB_BYTES} bytes".encode()


def test_each_format_has_a_tag_of_its_own(service: Service, files):
    endings = ("glb", *MESH_TYPES)
    tags = [get(service, f"{files}/body_canonical.{each}").headers["ETag"] for each in endings]
    assert len(set(tags)) == len(endings)
    glb = get(service, f"{files}/body_canonical.glb")
    assert tags[0] == f'"{hashlib.sha256(glb.content).hexdigest()}"'
    url = f"{files}/body_canonical.ply"
    whole = get(service, url)
    assert whole.headers["Cache-Control"] == "no-store"
    assert get(service, url, If_None_Match=whole.headers["ETag"]).status_code == 304
    assert get(service, url, If_None_Match=tags[0]).status_code == 200


@pytest.mark.parametrize("accept", [BROWSER, "model/obj"])
def test_a_name_says_the_format_whatever_is_accepted(service: Service, files, accept):
    answer = get(service, f"{files}/body_canonical.glb", Accept=accept)
    assert (answer.headers["content-type"], len(answer.content)) == (GLB, GLB_BYTES)
    octets = get(service, f"{files}/body_canonical.glb", Accept="application/octet-stream")
    assert octets.headers["content-type"] == "application/octet-stream"
    assert (octets.content, octets.headers["Vary"]) == (answer.content, "Accept")
    picture = get(service, f"{files}/views/0/overlay.png", Accept=accept)
    assert picture.headers["content-type"] == "image/png"


@pytest.mark.parametrize(
    "name",
    [
        *("body_canonical.fbx", "body_canonical", ".obj", "body_canonical.mtl"),
        *("overlay.png", "views/0/overlay.obj", "measurements.json"),
    ],
)
def test_a_file_that_is_not_there_is_told_with_those_that_are(service: Service, files, name):
    problem = checked(get(service, f"{files}/{name}"), 404)
    assert f"'{name}'" in problem.detail
    assert "body_canonical.glb" in problem.remedy
    for there in ("views/0/overlay.png", "person.npz", "result.json"):
        assert there in problem.remedy


def test_a_fit_without_a_result_says_what_there_is(service: Service):
    path = service.submit({"unusable": True})
    service.ended(path)
    for name in ("body_canonical.obj", "measurements.csv"):
        problem = checked(get(service, f"{path}/files/{name}"), 404)
        assert problem.remedy.startswith("Ask for views/0/image. The state is failed")


def test_measurements_are_a_table_with_units(service: Service, files):
    answer = get(service, f"{files}/measurements.csv")
    assert answer.headers["content-type"] == "text/csv; charset=utf-8"
    (row,) = csv.DictReader(io.StringIO(answer.text))
    told = get(service, files.replace("/files", "/result")).json()["measurements"][0]
    assert (row["name"], row["unit"], float(row["value"])) == ("waist_girth", "cm", told["value"])
    assert (row["standard_error"], row["given"]) == ("1.0", "false")
    tag = answer.headers["ETag"]
    assert get(service, f"{files}/measurements.csv", If_None_Match=tag).status_code == 304


def test_files_that_are_not_listed_stay_out_of_the_links(service: Service, files):
    links = service.job(files.replace("/files", ""))["links"]["files"]
    assert {"body_canonical.glb", "views/0/body_posed.glb", "result.json"} <= set(links)
    assert not {name for name in links if name.endswith((".csv", *MESH_TYPES))}


def test_a_body_of_measurements_is_answered_in_the_format_asked_for(service: Service):
    def post(named: str) -> httpx.Response:
        return service.client.post(f"/v1/bodies?format={named}", json={"gender": "male"})

    for named, media_type in {
        "json": "application/json",
        "glb": GLB,
        "ply": "model/ply",
        "csv": "text/csv; charset=utf-8",
    }.items():
        answer = post(named)
        assert (answer.status_code, answer.headers["content-type"]) == (200, media_type)
    assert post("glb").content == GLB_CONTENT
    assert post("obj").content == f"obj of {GLB_BYTES} bytes".encode()
    (row,) = csv.DictReader(io.StringIO(post("csv").text))
    assert (row["name"], row["unit"], row["low"], row["high"]) == (
        "waist_girth_navel",
        "cm",
        "70.0",
        "90.0",
    )
    assert checked(post("fbx"), 422).field == "format"


def test_without_an_estimator_stored_files_are_there_and_others_are_for_later(tmp_path):
    with running_service(Machine(tmp_path), estimator="broken") as service:
        files = f"{service.fitted()}/files"
        assert get(service, f"{files}/body_canonical.glb").status_code == 200
        assert get(service, f"{files}/measurements.csv").status_code == 200
        answer = get(service, f"{files}/body_canonical.obj")
        assert checked(answer, 503).code == "estimator-unavailable"
        assert int(answer.headers["Retry-After"]) > 0
