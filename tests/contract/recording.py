"""The examples of the OpenAPI document: what a service was asked, and what it answered.

``python -m tests.contract.recording`` (``make examples``) asks one and writes
``service/api/examples.json``: requests by operation, answers by operation and status, and notices.
They come out the same each time: of long lists the beginning is kept, and ids, times, secrets and
digests are always the same, so that what is answered twice alike is said once in the document.
"""

import io
import json
import os
import re
import sys
import tempfile
import time
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
from tests.contract.document import exported, operations
from tests.e2e.service import (
    REPOSITORY,
    started_service,
    wait_for_estimator,
    wait_until_ready,
)
from tests.integration.service.receiver import Receiver, receiving

SHOWN = "https://example.org/hooks/maquette"
"""Stands for the address that notices are really sent to."""

FIT = "b0d3cd76-33ef-4c01-b18c-190159d7df68"
"""The id that stands for that of any fit."""

UUID = r"[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12}"
MOMENT = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(?:\.\d+)?(?=Z)")
SAME: tuple[tuple[str, str], ...] = (
    (r'(?<="expires_at": ")[^"]+', "2026-05-11T09:30:05.995Z"),
    (r"http://127\.0\.0\.1:\d+/\w*", SHOWN),
    (r"cursor=\d+\.\d+-", "cursor=1777887000.995-"),
    (
        r"(?<=\"sha256\": \")[0-9a-f]{64}",
        "d749f854970d25e805a6f10b7ec3a75d2b0060b9eb3333653b6c95baa7a1608c",
    ),
)

FIGURE = re.compile(r"\d+(?:\.\d+)?(?:e-?\d+)?")
PASSING = ("stage", "progress", "view")

SHOWN_EVENTS = 4
"""How to retry, that the fit waits and runs, and where it is first."""

MOST_ITEMS = 4
SHORTENED = 2
ONE_IS_ENOUGH = ("bodies", "limb_facing", "limbs", "models", "stages")
MAPS = ("points", "pose", "residual_px")
"""Objects whose names are many: the first is kept."""


class Recorder:
    """Asks a service, and keeps questions and answers by operation."""

    def __init__(self, client: httpx.Client, receiver: Receiver) -> None:
        self.requests: dict[str, dict[str, Any]] = {}
        self.answers: dict[str, dict[str, dict[str, Any]]] = {}
        self.notices: dict[str, Any] = {}
        self._client = client
        self._receiver = receiver
        self._operations = [
            (each.method, re.compile(re.sub(r"\{\w+\}", "[^/]+", each.path)), each.id)
            for each in operations(exported())
        ]

    def ask(
        self, shown_as: str, method: str, path: str, *, asked_as: str = "", **sent: Any
    ) -> httpx.Response:
        """Ask, and keep the answer under a name, and what was asked if it has one too."""
        operation = next(
            name
            for verb, pattern, name in self._operations
            if verb == method.lower() and pattern.fullmatch(path.partition("?")[0])
        )
        if asked_as:
            self.requests.setdefault(operation, {})[asked_as] = sent["json"]
        if "json" in sent:
            real = json.dumps(sent["json"]).replace(SHOWN, self._receiver.url())
            sent["json"] = json.loads(real)
        answer = self._client.request(method, path, **sent)
        assert answer.is_success, answer.text
        if shown_as:
            kept = self.answers.setdefault(operation, {}).setdefault(str(answer.status_code), {})
            kind = answer.headers["content-type"].partition(";")[0]
            said = answer.json() if kind == "application/json" else answer.text
            said = _first_and_last(said) if kind == "text/event-stream" else said
            kept.setdefault(shown_as, self._shown(said))
        return answer

    def until_ended(self, path: str) -> dict[str, Any]:
        """Wait for the end of a fit."""
        return self.until(path, lambda fit: fit["state"] not in ("queued", "running"))

    def until(self, path: str, is_so: Any) -> dict[str, Any]:
        """Look at a fit until it is as it should be."""
        while not is_so(fit := self._client.get(path).raise_for_status().json()):
            time.sleep(0.05)
        return fit

    def take_notice(self, name: str) -> None:
        """Keep the next notice."""
        while not self._receiver.notices:
            time.sleep(0.05)
        self.notices[name] = self._shown(self._receiver.notices.pop(0).event)

    def _shown(self, value: Any) -> Any:
        """The value as an example: short, and with ids and times that are always the same."""
        text = json.dumps(_short(value))
        for found in re.findall(rf"/fits/({UUID})", text):
            text = text.replace(found, FIT)
        for second, moment in enumerate(sorted(set(MOMENT.findall(text)))):
            text = text.replace(f"{moment}Z", f"2026-05-04T09:30:{second:02}.995Z")
        for pattern, same in SAME:
            text = re.sub(pattern, same, text)
        return json.loads(text)


def _first_and_last(stream: str) -> str:
    """A stream of events without most of those that tell of progress."""
    events = stream.removesuffix("\n\n").split("\n\n")
    return "\n\n".join((*events[:SHOWN_EVENTS], *events[-2:])) + "\n\n"


def _short(value: Any, name: str = "") -> Any:
    if isinstance(value, float):
        return float(f"{value:.4g}")
    if isinstance(value, list):
        kept = value if len(value) <= MOST_ITEMS else value[:SHORTENED]
        kept = kept[:1] if name in ONE_IS_ENOUGH else kept
        return [_short(each) for each in kept]
    if isinstance(value, dict):
        items = list(value.items())
        if name in MAPS:
            items = items[:1]
        if name == "files":
            items = items[:SHORTENED]
        return {key: _short(each, key) for key, each in items}
    return value


def differences(recorded: Any, shown: Any, where: str = "") -> list[str]:
    """Where what was recorded is otherwise than what is shown, but for figures.

    A machine computes other last digits, needs other times and writes files of other sizes; how far
    a fit has come when it is looked at is chance.
    """
    if isinstance(recorded, dict) and isinstance(shown, dict):
        names = recorded.keys() | shown.keys()
        if recorded.keys() != shown.keys():
            return [f"{where}: {sorted(recorded.keys() ^ shown.keys())}"]
        chance = PASSING if recorded.get("state") == "running" else ()
        return [
            each
            for name in sorted(names - set(chance))
            for each in differences(recorded[name], shown[name], f"{where}.{name}")
        ]
    if isinstance(recorded, list) and isinstance(shown, list):
        if len(recorded) != len(shown):
            return [f"{where}: {len(recorded)} items, not {len(shown)}"]
        pairs = enumerate(zip(recorded, shown, strict=True))
        return [each for number, pair in pairs for each in differences(*pair, f"{where}.{number}")]
    if _is_figure(recorded) and _is_figure(shown):
        return []
    if isinstance(recorded, str) and isinstance(shown, str):
        recorded, shown = (FIGURE.sub("0", each) for each in (recorded, shown))
    return [] if recorded == shown else [f"{where}: {recorded!r}, not {shown!r}"]


def _is_figure(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


RECORDED = Path(service.api.__file__).parent / "examples.json"

WEBHOOK = {"url": SHOWN, "secret": "whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD"}
PRODUCTS: Mapping[str, Mapping[str, Any]] = {
    "texture": {"kind": "texture", "colours": "albedo", "size": 2048},
    "pose": {
        "kind": "pose",
        "pose": "standing",
        "rotations": {"head": [0.0, 0.35, 0.0], "left_forearm": [0.0, 0.0, 0.0, 1.0]},
    },
    "walk": {"kind": "animation", "motion": "walk"},
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
