"""Submissions as callers make them, of the evaluation suite's pictures."""

import json
from dataclasses import dataclass

from api_schemas.fit import FitRequest as AskedFit
from fitter.request import FitRequest
from fitter.vocabulary.choices import Cues
from service.jobs.inputs import SentPicture
from service.submissions.refusal import parsed
from service.submissions.submission import check_submission

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
    said: dict[str, object] = {
        "points": {
            name: {"x": click.x, "y": click.y, "visibility": 1 if click.occluded else 2}
            for name, click in view.clicks.items()
        }
    }
    if view.focal_length_px is not None:
        said["focal_length_px"] = view.focal_length_px
    asked = {
        "gender": request.person.gender.value,
        "height_m": request.person.height_m,
        "cues": view.cues.value,
        "views": [said],
    }
    return Submission(image=view.image, request=json.dumps(asked))


def checked(request: bytes, *images: bytes, max_pixels: int = 10_000_000) -> AskedFit:
    """A request as the service understands it, of these pictures."""
    asked = parsed(AskedFit, request, whole="request", called="the part 'request'")
    pictures = [SentPicture(image, None) for image in images]
    return check_submission(asked, pictures, max_pixels=max_pixels).request


def small_submissions(count: int) -> list[Submission]:
    """Real fits that cost little: small pictures of the suite, by silhouette and edges alone."""
    from tests.benchmarks.requests import suite_requests

    width, height = SMALL
    requests = suite_requests(count, width=width, height=height, cues=Cues.SE)
    return [submission(request) for request in requests]
