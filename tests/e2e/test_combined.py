"""Two real pictures of one person, over HTTP, by SES and with a mask: one body, in both."""

import io
import json

import httpx
from PIL import Image

from api_schemas.derivation_kinds.combined import CombinedResult
from tests.e2e.service import ended_job
from tests.evaluation.cases import CASES
from tests.evaluation.files import CaseFiles, encoded_mask, read_case

PICTURES = ("man_middle_aged_thin_standing", "man_middle_aged_thin_turned")


def fitted(client: httpx.Client, files: CaseFiles, *, mask: bool) -> str:
    parts = {
        "image": ("picture.jpg", files.image, "image/jpeg"),
        "request": ("request.json", json.dumps(files.request), "application/json"),
    }
    if mask:
        parts["mask"] = ("mask.png", encoded_mask(files.person_mask), "image/png")
    answer = client.post("/v1/fits", files=parts)
    assert answer.status_code == 202, answer.text
    job = ended_job(client, answer)
    assert job["state"] == "succeeded", job
    return job["id"]


def test_one_person_is_found_in_two_pictures(service: httpx.Client):
    files = [read_case(CASES[name]) for name in PICTURES]
    client = service
    one, other = fitted(client, files[0], mask=False), fitted(client, files[1], mask=True)
    asked = {"kind": "combined", "fits": [other]}
    job = ended_job(client, client.post(f"/v1/fits/{one}/derivations", json=asked))
    assert job["state"] == "succeeded", job
    links = job["links"]
    document = client.get(links["result"]).content
    result = CombinedResult.model_validate_json(document)
    assert not result.warnings
    assert [str(each.fit_id) for each in result.bodies] == [one, other]
    for each, picture in zip(result.bodies, files, strict=True):
        assert each.body.shape == result.shape
        assert each.silhouette_overlap > 0.9
        assert each.light is not None
        assert each.reflectance is not None
        assert client.get(links["artifacts"][f"body_posed_{each.number}.glb"]).content[:4] == (
            b"glTF"
        )
        overlay = client.get(links["artifacts"][f"overlay_{each.number}.png"]).content
        sent = Image.open(io.BytesIO(picture.image))
        assert Image.open(io.BytesIO(overlay)).size == sent.size
    alone = client.get(f"/v1/fits/{one}/result").json()["measurements"]
    waist = {each["name"]: each["standard_error"] for each in alone}["waist_girth_navel"]
    together = {each.name: each.standard_error for each in result.measurements}
    assert together["waist_girth_navel"] < waist
    assert client.delete(f"/v1/fits/{one}").status_code == 204
    assert client.get(links["self"]).status_code == 404
    assert client.get(f"/v1/fits/{other}").status_code == 200
