"""Nothing of a picture, its points or its result is left on the disk when its job is gone."""

import hashlib
import time
from collections.abc import Iterator
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from tests.integration.service.fake_pipeline import scripted_image
from tests.integration.service.harness import (
    FRONT_AND_SIDE,
    VIEW,
    Machine,
    Service,
    eventually,
    running_service,
)
from tests.integration.service.test_images import blobs_below

RETENTION_HOURS = 2.0
SCRIPT = {"n": "the-picture-itself"}
SECRET = "whsec_" + "eraseThisSecretAtTheEndX" * 2
WEBHOOK = {"url": "http://127.0.0.1:9/erase-this-address", "secret": SECRET}
PERSON = {"weight_kg": 83.7654321, "webhook": WEBHOOK}
POINTS = {**VIEW["points"], "nose": [321.1234567, 61.7654321]}
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


def fitted(service: Service) -> str:
    """Have the remarkable picture fitted, seen twice, and return the fit's path."""
    views = [{"view": view, "points": POINTS} for view in ("front", "side")]
    answer = service.post_several(
        SCRIPT,
        SCRIPT,
        request=FRONT_AND_SIDE | PERSON | {"views": views},
        masks=[scripted_image(SCRIPT)] * 2,
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


def test_after_delete_no_byte_is_left(erasing: Service):
    service, folder = erasing, erasing.machine.data_dir
    path = fitted(service)
    assert service.ended(path)["state"] == "succeeded"
    picture = {"image": ("p.png", scripted_image(SCRIPT), "image/png")}
    uploaded = service.client.post("/v1/images", files=picture).headers["Location"]
    assert traces(folder) == set(TRACES)
    assert service.client.delete(path).status_code == 204
    assert service.client.delete(uploaded).status_code == 204
    eventually(lambda: not traces(folder), what=f"nothing is left of {set(TRACES)}")
    eventually(lambda: not blobs_below(folder), what="no file is left")


def test_after_its_time_no_byte_is_left(erasing: Service):
    service, folder = erasing, erasing.machine.data_dir
    path = fitted(service)
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
