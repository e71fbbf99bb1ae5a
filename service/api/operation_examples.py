"""Requests and answers for the OpenAPI document.

Tables by operation, then by status: :func:`service.api.openapi.complete_openapi` puts them where
they belong. Examples of problems are where the problems are documented.
"""

from collections.abc import Mapping
from typing import Any, Final

from service.api.derivation_kinds import KINDS
from service.api.examples import derivations, estimates, jobs, results, scans, whole_service
from service.api.job_resources import FITS, OF_FITS, OF_SCANS, SCANS, JobResource

Examples = Mapping[str, Any]
"""Values by their names."""

_DERIVATIONS: Final[Examples] = {
    name: request for kind in KINDS.values() for name, request in kind.requests.items()
} | {"told-of-its-end": derivations.TOLD_OF_ITS_END}

_SHOWN: Final = ("report", "caricature", "pose", "combined", "figure", "texture", "animation")
"""The order of the first results in the document; those of other kinds follow."""

_DERIVED: Final[Examples] = {kind: KINDS[kind].answer for kind in dict.fromkeys((*_SHOWN, *KINDS))}

UPLOADED: Final = {"photograph": estimates.UPLOADED_IMAGE}

REQUESTS: Final[Mapping[str, Examples]] = {
    "submit": jobs.SUBMISSIONS,
    "derive": _DERIVATIONS,
    "submit_scan": scans.SUBMISSIONS,
    "make_token": {"for-one-customer": {"jobs": 2, "label": "customer-4711"}},
    "derive_of_scan": _DERIVATIONS,
    "initial_pose": estimates.INITIAL_POSE_REQUESTS,
    "estimate_body": estimates.BODY_REQUESTS,
    "propose_points": estimates.POINTS_REQUESTS,
    "check_capture": estimates.CHECK_REQUESTS,
}


def _of_jobs(
    of: JobResource,
    *,
    accepted: Examples,
    ended: Examples,
    under_way: Examples,
    page: Examples,
    canceled: Any,
    stopping: Any,
    events: Examples,
    request: Examples,
    results: Examples,
) -> dict[str, Mapping[int, Examples]]:
    """Answers about fits, about scans or about what is derived from one of them."""
    return {
        of.operations[operation]: answers
        for operation, answers in {
            "submit": {200: ended, 202: accepted},
            "retry": {200: ended, 202: accepted},
            "list": {200: page},
            "get": {200: {**accepted, **under_way, **ended}},
            "cancel": {200: {"canceled": canceled}, 202: {"stopping": stopping}},
            "follow": {200: events},
            "request": {200: request},
            "result": {200: results},
            "artifact": {200: {"result.json": next(iter(results.values()))}},
        }.items()
    }


_FITS: Final = _of_jobs(
    FITS,
    accepted=jobs.ACCEPTED,
    ended=jobs.ENDED,
    under_way=jobs.RUNNING,
    page={"first-page": jobs.PAGE},
    canceled=jobs.CANCELED,
    stopping=jobs.STOPPING,
    events={"short-fit": jobs.EVENTS},
    request={"as-understood": jobs.OPTIONS},
    results={"man-by-point-light": results.RESULT},
)
_SCANS: Final = _of_jobs(
    SCANS,
    accepted=scans.ACCEPTED,
    ended=scans.ENDED,
    under_way=scans.UNDER_WAY,
    page={"first-page": scans.PAGE},
    canceled=scans.CANCELED,
    stopping=scans.STOPPING,
    events={"short-scan": scans.EVENTS},
    request={"as-understood": scans.OPTIONS},
    results={"front-and-side": scans.RESULT},
)
_DERIVATIONS_OF_FITS: Final = _of_jobs(
    OF_FITS,
    accepted=derivations.ACCEPTED,
    ended=derivations.ENDED,
    under_way={},
    page={"only-page": derivations.PAGE},
    canceled=derivations.CANCELED,
    stopping=derivations.STOPPING,
    events={"report": jobs.EVENTS},
    request=derivations.UNDERSTOOD,
    results=_DERIVED,
)
_DERIVATIONS_OF_SCANS: Final = _of_jobs(
    OF_SCANS,
    accepted=scans.DERIVATION_ACCEPTED,
    ended=scans.DERIVATION_ENDED,
    under_way={},
    page={"only-page": scans.DERIVATION_PAGE},
    canceled=scans.DERIVATION_CANCELED,
    stopping=scans.DERIVATION_STOPPING,
    events={"caricature": jobs.EVENTS},
    request=derivations.UNDERSTOOD,
    results={"caricature": _DERIVED["caricature"]},
)

ANSWERS: Final[Mapping[str, Mapping[int, Examples]]] = {
    **_FITS,
    **_SCANS,
    **_DERIVATIONS_OF_FITS,
    **_DERIVATIONS_OF_SCANS,
    "submit_scan": {**_SCANS["submit_scan"], 422: scans.REFUSED},
    "make_token": {201: {"for-a-quarter-of-an-hour": jobs.TOKEN}},
    "list_tokens": {200: {"only-page": jobs.TOKENS}},
    "get_token": {200: {"one-job-left": jobs.STANDING_TOKEN}},
    "list_people": {200: {"first-page": jobs.PEOPLE}},
    "upload_image": {200: UPLOADED, 201: UPLOADED},
    "list_images": {200: {"only-page": {"images": [estimates.UPLOADED_IMAGE], "next": None}}},
    "get_image": {200: UPLOADED},
    "initial_pose": {200: {"standing": estimates.INITIAL_POSE_ANSWER}},
    "estimate_body": {200: {"from-height-and-weight": estimates.BODY_ANSWER}},
    "propose_points": {200: {"standing": estimates.POINTS_ANSWER}},
    "check_capture": {200: estimates.CHECK_ANSWERS},
    "body_models": {200: {"both": whole_service.BODY_MODELS}},
    "live": {200: {"live": {"status": "live"}}},
    "ready": {200: {"ready": {"status": "ready", "workers": 1, "queued": 0}}},
    "metrics": {200: {"some": whole_service.METRICS}},
    "problem_type": {200: {"no-result": whole_service.PROBLEM_TYPE}},
}

NOTICE: Final = jobs.NOTICE
DERIVATION_NOTICE: Final = derivations.NOTICE
SCAN_NOTICE: Final = scans.NOTICE
SCAN_DERIVATION_NOTICE: Final = scans.DERIVATION_NOTICE
