"""Nothing of a picture, its points or its result is left on the disk when its job is gone."""

import hashlib
import time
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    REQUEST,
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.scanning import FRONT, SCAN, SIDE, of_either, post_scan
from tests.integration.service.test_images import blobs_below

RETENTION_HOURS = 2.0
SCRIPT = {"n": "the-picture-itself"}
SECRET = "whsec_" + "eraseThisSecretAtTheEndX" * 2
WEBHOOK = {"url": "http://127.0.0.1:9/erase-this-address", "secret": SECRET}
PERSON = {"weight_kg": 83.7654321, "webhook": WEBHOOK}
POINTS = {"points": {**REQUEST["points"], "nose": [321.1234567, 61.7654321]}}
TRACES: dict[str, bytes] = {
    "picture": b"the-picture-itself",
    "picture's name": hashlib.sha256(scripted_image(SCRIPT)).hexdigest().encode(),
    "points": b"321.1234567",
    "weight, in request and result": b"83.7654321",
    "result": b"The energy stopped decreasing.",
    "receiver": b"erase-this-address",
    "receiver's secret": SECRET.encode(),
}


def traces(folder: Path) -> set[str]:
    """What is found in any file: blobs, the database, its write-ahead log."""
    found: set[str] = set()
    for path in folder.rglob("*"):
        try:
            content = path.read_bytes() if path.is_file() else b""
        except FileNotFoundError:  # erased while we look
            continue
        found |= {name for name, trace in TRACES.items() if trace in content}
    return found


def fitted(service: Service, resource: str) -> str:
    """Have the remarkable picture fitted, or a scan of it twice made, and return the job's path."""
    if resource == "fits":
        answer = service.post(SCRIPT, request=REQUEST | PERSON | POINTS)
    else:
        views = [FRONT | POINTS, SIDE | POINTS]
        masks = dict.fromkeys(range(2), scripted_image(SCRIPT))
        answer = post_scan(
            service, SCRIPT, SCRIPT, request=SCAN | PERSON | {"views": views}, masks=masks
        )
    assert answer.status_code == 202, answer.text
    return answer.headers["Location"]


SETTINGS = {
    "webhook_hosts": "127.0.0.1",
    "sweep_interval_s": 0.3,
    "retention_hours": RETENTION_HOURS,
}


@pytest.fixture(scope="module")
def erasing(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Service]:
    """A service that sweeps; whoever uses it leaves no trace."""
    machine = Machine(tmp_path_factory.mktemp("erasing"), settings=SETTINGS)
    with running_service(machine) as service:
        yield service


@of_either
def test_after_delete_no_byte_is_left(erasing: Service, resource: str):
    service, folder = erasing, erasing.machine.data_dir
    path = fitted(service, resource)
    assert service.ended(path)["state"] == "succeeded"
    for kind in ("pose", "texture"):
        asked = {"kind": kind, "webhook": WEBHOOK}
        answer = service.client.post(f"{path}/derivations", json=asked)
        derived = answer.headers["Location"]
        assert service.ended(derived)["state"] == "succeeded"
    picture = {"image": ("p.png", scripted_image(SCRIPT), "image/png")}
    uploaded = service.client.post("/v1/images", files=picture).headers["Location"]
    assert traces(folder) == set(TRACES)
    assert service.client.delete(path).status_code == 204
    assert service.client.delete(uploaded).status_code == 204
    eventually(lambda: not traces(folder), what=f"nothing is left of {set(TRACES)}")
    eventually(lambda: not blobs_below(folder), what="no file is left")
    assert service.client.get(derived).status_code == 404


@of_either
def test_after_its_time_no_byte_is_left(erasing: Service, resource: str):
    service, folder = erasing, erasing.machine.data_dir
    path = fitted(service, resource)
    job = service.ended(path)
    ended_at, expires_at = (
        datetime.fromisoformat(job[name]) for name in ("finished_at", "expires_at")
    )
    assert expires_at - ended_at == timedelta(hours=RETENTION_HOURS)
    eventually(lambda: traces(folder) == set(TRACES), what="the job was there")
    service.machine.rewrite(path, expires_at=time.time())
    eventually(lambda: service.client.get(path).status_code == 410, what="expired")
    eventually(lambda: not traces(folder), what=f"nothing is left of {set(TRACES)}")
    eventually(lambda: not blobs_below(folder), what="no file is left")
    assert service.client.get(path).status_code == 410
    other = {"fits": "scans", "scans": "fits"}[resource]
    assert service.client.get(path.replace(resource, other)).status_code == 404
