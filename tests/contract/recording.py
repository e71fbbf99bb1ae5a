"""The examples of the OpenAPI document: what a service was asked, and what it answered.

``python -m tests.contract.recording`` (``make examples``) asks one and writes
``service/api/examples.json``: requests by operation, answers by operation and status, and notices.
"""

import io
import json
import os
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import httpx
from PIL import Image

import service.api
from service.api.fits import FITS
from service.demo_data.sample import FOLDER, load_sample
from service.jobs.database import open_database, prepare_database
from service.jobs.keys import KeyRing
from service.settings import Settings
from tests.contract.recorder import SHOWN, Recorder
from tests.e2e.service import (
    REPOSITORY,
    started_service,
    wait_for_estimator,
    wait_until_ready,
)
from tests.integration.service.receiver import Receiver, receiving

RECORDED = Path(service.api.__file__).parent / "examples.json"

WEBHOOK = {"url": SHOWN, "secret": "whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD"}
PRODUCTS: Mapping[str, Mapping[str, Any]] = {
    "texture": {"kind": "texture", "colours": "albedo", "size": 2048},
    "pose": {
        "kind": "pose",
        "pose": "standing",
        "rotations": {"head": [0.0, 0.35, 0.0], "left_forearm": [0.0, 0.0, 0.0, 1.0]},
    },
    "walk": {"kind": "animation"},
    "looks": {"kind": "caricature", "factor": 2.0, "exaggerated": "looks"},
    "page": {"kind": "print"},
    "size": {
        "kind": "size",
        "chart_csv": "size,chest_girth,waist_girth_navel\nS,90-94,76-80\nM,94-98,80-84\n",
        "ease": {"waist_girth_navel": 2},
    },
    "body-fat": {"kind": "composition", "age_years": 34},
}
SIZE = {"width": 720, "height": 960}
GIRTHS = {"waist_girth_navel": 88, "hip_girth": {"value": 98, "standard_error": 1.5}}


def record(client: httpx.Client, receiver: Receiver, *, metrics_key: str) -> dict[str, Any]:
    """Ask a service for one of everything."""
    recorder = Recorder(client, receiver)
    sample = load_sample()
    front, side = ((FOLDER / f"{view}.jpg").read_bytes() for view in ("front", "side"))
    person = json.loads(sample.request)
    (seen,) = person.pop("views")
    points = {name: [at["x"], at["y"]] for name, at in seen["points"].items()}
    image, *views = _images(recorder, sample.image, front, side)
    nobody = recorder.ask("", "POST", "/v1/images", files={"image": _empty()}).json()["id"]
    clicked = {"image_id": image, "points": points}
    fit = person | {"views": [clicked]}
    auto = {"gender": "female", "height_m": 1.68, "views": [{"image_id": image}]}
    asked = json.loads((FOLDER / "front_and_side.json").read_bytes())
    several = asked | {
        "views": [
            {"view": view["view"], "image_id": each, "points": view["points"]}
            for view, each in zip(asked["views"], views, strict=True)
        ]
    }
    _fits(
        recorder,
        {
            "uploaded-picture": fit,
            "points-proposed": auto,
            "front-and-side": several,
            "told-of-its-end": person
            | {"measurements": GIRTHS, "weight_kg": 75, "cues": "SE"}
            | {"label": "customer-4711", "webhook": WEBHOOK}
            | {"views": [clicked | {"focal_length_35mm": 50}]},
        },
        failing=auto | {"views": [{"image_id": nobody}]},
    )
    _estimates(recorder, image, points, person)
    _whole_service(recorder, metrics_key)
    return {
        "requests": dict(sorted(recorder.requests.items())),
        "answers": dict(sorted(recorder.answers.items())),
        "notices": recorder.notices,
    }


def _images(recorder: Recorder, *pictures: bytes) -> list[str]:
    kept = [
        recorder.ask("photograph", "POST", "/v1/images", files={"image": ("picture.jpg", each)})
        for each in (*pictures, pictures[0])
    ]
    recorder.ask("only-page", "GET", "/v1/images?limit=1")
    ids = [each.json()["id"] for each in kept]
    recorder.ask("photograph", "GET", f"/v1/images/{ids[0]}")
    return ids[:-1]


def _empty() -> bytes:
    """A picture that shows nobody."""
    encoded = io.BytesIO()
    Image.new("RGB", (600, 800), (120, 130, 140)).save(encoded, "PNG")
    return encoded.getvalue()


def _fits(
    recorder: Recorder, submissions: Mapping[str, Any], *, failing: Mapping[str, Any]
) -> None:
    """Ask for fits and all that can be asked of them."""
    for name, each in submissions.items():
        accepted = recorder.ask("queued", "POST", FITS, asked_as=name, json=each)
        told = recorder.until_ended(accepted.headers["Location"])
        assert told["state"] == "succeeded", told
        if name == "front-and-side":
            recorder.ask(name, "GET", told["links"]["result"])
    recorder.take_notice("fit-ended")
    usual, *_ = submissions.values()
    waiting = {"Prefer": "wait=60"}
    answer = recorder.ask("succeeded", "POST", FITS, json=usual, headers=waiting)
    links = answer.json()["links"]
    begun = recorder.ask("", "POST", FITS, json=usual | {"optimizer": "simplex"})
    path = begun.headers["Location"]
    recorder.until(path, lambda fit: fit["stage"] == "silhouette_and_edges")
    recorder.ask("running", "GET", path)
    recorder.ask("stopping", "POST", f"{path}/cancel")
    recorder.until_ended(path)
    recorder.ask("canceled", "POST", f"{path}/cancel")
    recorder.ask("succeeded", "GET", links["self"])
    recorder.ask("short", "GET", links["events"])
    recorder.ask("as-understood", "GET", links["request"])
    recorder.ask("sample", "GET", links["result"])
    recorder.ask("first-page", "GET", f"{FITS}?limit=1")
    recorder.ask("queued", "POST", links["products"], json={"kind": "pose", "pose": "sitting"})
    for name, each in PRODUCTS.items():
        made = recorder.ask(
            name, "POST", links["products"], asked_as=name, json=each, headers=waiting
        )
        assert made.json()["state"] == "succeeded", made.text
    recorder.ask("succeeded", "GET", made.json()["links"]["self"])
    failed = recorder.ask("", "POST", FITS, json=failing).headers["Location"]
    recorder.until_ended(failed)
    recorder.ask("failed", "GET", failed)


def _estimates(
    recorder: Recorder, image: str, points: Mapping[str, Any], person: Mapping[str, Any]
) -> None:
    known = person | {"points": points}
    for path, shown, asked, body in (
        ("initial-poses", "standing", "points-and-size", known | {"image_size": SIZE}),
        ("points", "standing", "largest-person", {"image_id": image}),
        ("points", "", "person-and-mask", {"image_id": image, "person": 0, "mask": True}),
        (
            "points",
            "camera-too-near",
            "lens-and-height",
            {"image_id": image, "view": "front", "height_m": 1.555, "focal_length_35mm": 14},
        ),
        ("bodies", "", "gender-alone", {"gender": "female"}),
        (
            "bodies",
            "from-height-and-weight",
            "height-and-weight",
            {"gender": "female", "height_m": 1.68, "weight_kg": 64.5},
        ),
        ("bodies", "", "girths", {"gender": "male", "measurements": GIRTHS}),
    ):
        recorder.ask(shown, "POST", f"/v1/{path}", asked_as=asked, json=body)


def _whole_service(recorder: Recorder, metrics_key: str) -> None:
    recorder.ask("both", "GET", "/v1/body-models")
    recorder.ask("live", "GET", "/healthz/live")
    recorder.ask("ready", "GET", "/healthz/ready")
    recorder.ask("no-result", "GET", "/problems/no-result")
    bearer = {"Authorization": f"Bearer {metrics_key}"}
    recorder.ask("some", "GET", "/metrics", headers=bearer)
    (figures,) = recorder.answers["get_metrics"].values()
    shown = ("maquette_queue_jobs", "maquette_workers_able")
    figures["some"] = "".join(
        f"{line}\n" for line in figures["some"].splitlines() if any(each in line for each in shown)
    )


def recorded_from_service(folder: Path) -> dict[str, Any]:
    """Start a service that asks for keys, in an empty folder, and record it."""
    url = Settings(data_dir=folder).system_database_url
    prepare_database(url)
    database = open_database(url, connections=1)
    keys = KeyRing(database)
    key, metrics_key = keys.create("shop"), keys.create("metrics")
    database.dispose()
    environment = {
        **os.environ,
        "MAQUETTE_AUTHENTICATION": "keys",
        "MAQUETTE_REQUESTS_PER_MINUTE": "1000000",
        "MAQUETTE_WEBHOOK_HOSTS": "127.0.0.1",
    }
    command = [sys.executable, "-m", "service.cli", "serve", "--port", "0"]
    with (
        receiving() as receiver,
        started_service(
            [*command, "--data-dir", str(folder)], cwd=REPOSITORY, environment=environment
        ) as client,
    ):
        client.headers["Authorization"] = f"Bearer {key}"
        wait_until_ready(client)
        wait_for_estimator(client)
        return record(client, receiver, metrics_key=metrics_key)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        found = recorded_from_service(Path(folder))
    RECORDED.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n")
