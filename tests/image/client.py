"""A user of the service, on another host than its API."""

import json
import time
from dataclasses import dataclass
from typing import Any, Final

import httpx

from tests.image.build import REPOSITORY

SAMPLE: Final = REPOSITORY / "service" / "demo_data"
FIT_WITHIN_S: Final = 600.0


@dataclass(frozen=True)
class Client:
    """The sample picture, and a key to the API."""

    http: httpx.Client

    def submit(self, *, cues: str) -> str:
        """Post the sample and return the job's path."""
        request = json.loads((SAMPLE / "request.json").read_text())
        answer = self.http.post(
            "/v1/fits",
            files={
                "image": ("sample.jpg", (SAMPLE / "sample.jpg").read_bytes(), "image/jpeg"),
                "request": (None, json.dumps({**request, "cues": cues})),
            },
        )
        assert answer.status_code == httpx.codes.ACCEPTED, answer.text
        return answer.headers["Location"]

    def proposed(self) -> int:
        """How many points of the sample the detector proposes; none before it has started."""
        picture = ("sample.jpg", (SAMPLE / "sample.jpg").read_bytes(), "image/jpeg")
        answer = self.http.post("/v1/points", files={"image": picture})
        if answer.status_code == httpx.codes.SERVICE_UNAVAILABLE:
            return 0
        return len(answer.raise_for_status().json()["points"])

    def ended(self, path: str) -> dict[str, Any]:
        """Wait for a job's end."""
        deadline = time.monotonic() + FIT_WITHIN_S
        while True:
            job = self.http.get(path).raise_for_status().json()
            if job["state"] not in {"queued", "running"}:
                return job
            assert time.monotonic() < deadline, f"{path} did not end"
            time.sleep(0.2)

    def result(self, job: dict[str, Any]) -> dict[str, Any]:
        """Fetch the result of a job that succeeded, and look whether its body can be fetched."""
        assert job["state"] == "succeeded", job
        body = self.http.get(job["links"]["files"]["views/0/body_posed.glb"]).raise_for_status()
        assert body.content.startswith(b"glTF")
        return self.http.get(job["links"]["result"]).raise_for_status().json()


def connect(address: str, key: str) -> Client:
    """Speak to the API with a key."""
    return Client(
        httpx.Client(base_url=address, headers={"Authorization": f"Bearer {key}"}, timeout=60.0)
    )


def answers(address: str) -> bool:
    """Say whether an API answers there."""
    try:
        return httpx.get(f"{address}/healthz/live").is_success
    except httpx.TransportError:
        return False
