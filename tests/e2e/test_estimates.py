"""What is answered at once, by the service as a user starts it."""

import json
from pathlib import Path

import httpx
import trimesh

from service.demo_data.sample import load_sample
from tests.e2e.service import ended_job

STOUT = {"weight_kg": 70.0, "measurements": {"waist_girth_navel": 160.0}}


def test_bodies_and_poses_are_answered_at_once_and_contradictions_by_the_fit(
    service: httpx.Client, tmp_path: Path
):
    client = service
    sample = load_sample()
    subject = json.loads(sample.request)
    (view,) = subject.pop("views")
    known = {"gender": "female", "height_m": 1.68, "weight_kg": 64.5}
    estimate = client.post("/v1/bodies", json=known).raise_for_status().json()
    weight = next(each for each in estimate["measurements"] if each["name"] == "weight")
    assert abs(weight["value"] - 64.5) < 0.1
    glb = client.post("/v1/bodies?format=glb", json=known)
    (tmp_path / "body.glb").write_bytes(glb.content)
    mesh = trimesh.load_mesh(tmp_path / "body.glb")
    assert mesh.is_watertight
    assert 50.0 < 1000.0 * mesh.volume < 80.0

    picture = {"image": ("sample.jpg", sample.image, "image/jpeg")}
    image = client.post("/v1/images", files=picture).raise_for_status().json()
    seen = view | {"image_size": {side: image[side] for side in ("width", "height")}}
    pose = client.post("/v1/initial-poses", json=subject | seen).raise_for_status().json()
    assert pose["camera"]["width"] == image["width"]

    seen = view | {"image_id": image["id"]}
    refused = ended_job(client, client.post("/v1/fits", json=subject | {"views": [seen]} | STOUT))
    assert refused["state"] == "failed"
    assert refused["problem"]["code"] == "contradictory-measurements"
