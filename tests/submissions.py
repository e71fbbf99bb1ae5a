"""Submissions as callers make them, of the evaluation suite's pictures."""

import json
from dataclasses import dataclass

from fitter.request import FitRequest
from fitter.vocabulary.choices import Cues

SMALL = (120, 160)
"""Of so small a picture a fit by silhouette and edges takes less than a second."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Submission:
    """An encoded picture, and the JSON text of what is asked of it."""

    image: bytes
    request: str

    @property
    def files(self) -> dict[str, tuple[str, bytes | str, str]]:
        """The parts of the multipart body."""
        return {
            "image": ("picture", self.image, "application/octet-stream"),
            "request": ("request.json", self.request, "application/json"),
        }


def submission(request: FitRequest) -> Submission:
    """Write a request of the fitter as a caller of the service would."""
    (view,) = request.views
    options: dict[str, object] = {
        "gender": request.person.gender.value,
        "height_m": request.person.height_m,
        "cues": view.cues.value,
        "points": {
            name: {"x": click.x, "y": click.y, "visibility": 1 if click.occluded else 2}
            for name, click in view.clicks.items()
        },
    }
    if view.focal_length_px is not None:
        options["focal_length_px"] = view.focal_length_px
    return Submission(image=view.image, request=json.dumps(options))


def scan_files(sent: Submission) -> dict[str, tuple[str, bytes | str, str]]:
    """The parts of a scan of one picture seen twice, first from the front."""
    asked = json.loads(sent.request)
    seen = {name: asked.pop(name) for name in ("points", "focal_length_px") if name in asked}
    views = [{"view": kind, **seen} for kind in ("front", "other")]
    picture = sent.files["image"]
    request = json.dumps(asked | {"views": views})
    return {
        "image_0": picture,
        "image_1": picture,
        "request": ("request.json", request, "application/json"),
    }


def small_submissions(count: int) -> list[Submission]:
    """Real fits that cost little: small pictures of the suite, by silhouette and edges alone."""
    from tests.benchmarks.requests import suite_requests

    width, height = SMALL
    requests = suite_requests(count, width=width, height=height, cues=Cues.SE)
    return [submission(request) for request in requests]
