"""The answers of a sandbox: of any picture what is said of a sample, in that picture's pixels.

What needs no person in a picture is answered as everywhere.
"""

from pathlib import Path

from api_schemas.checks import CaptureCheck, CheckRequest
from api_schemas.points import PointsFormat
from api_schemas.proposals import PointsRequest
from api_schemas.scans import ScanRequest
from fitter.vocabulary.choices import ViewKind
from service.demo_data.sample import load_sample, load_scan_sample
from service.estimates import answers
from service.estimates.questions import ProposedPoints
from service.estimates.sandbox_scale import scale_between
from service.estimates.tasks import estimate_tasks
from service.submissions.submission import placed_question


def points(
    asked: PointsRequest, image: bytes, *, max_pixels: int, detector: Path | None
) -> ProposedPoints:
    """Propose the points of the sample, scaled to the picture."""
    sample = load_sample().image
    found = answers.points(asked, sample, max_pixels=max_pixels, detector=detector)
    scale = scale_between(sample, image)
    return ProposedPoints(
        proposal=scale.proposal(found.proposal),
        mask=scale.grey_png(found.mask) if found.mask else b"",
    )


def check(
    asked: CheckRequest, image: bytes, *, max_pixels: int, detector: Path | None
) -> CaptureCheck:
    """Check the sample from the side, or from the front whatever else is asked for."""
    sample = load_scan_sample()
    place = 1 if asked.view is ViewKind.SIDE else 0
    own_points = ScanRequest.model_validate_json(sample.request).views[place].points
    request = CheckRequest(
        view=asked.view if asked.view is ViewKind.SIDE else ViewKind.FRONT,
        person=asked.person,
        points=own_points if asked.points and not isinstance(own_points, str) else {},
        format=PointsFormat.NAMED,
        gender=asked.gender,
        height_m=asked.height_m,
        focal_length_35mm=asked.focal_length_35mm,
    )
    picture = sample.images[place]
    placed = placed_question(request, picture, max_pixels=max_pixels)
    found = answers.check(placed, picture, max_pixels=max_pixels, detector=detector)
    return scale_between(picture, image).check(found)


TASKS = estimate_tasks(
    body=answers.body,
    initial_pose=answers.initial_pose,
    points=points,
    check=check,
    conversion=answers.conversion,
    jpeg=answers.jpeg,
)
