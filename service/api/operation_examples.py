"""Requests and answers for the OpenAPI document.

Tables by operation, then by status: :func:`service.api.openapi.complete_openapi` puts them where
they belong. Examples of problems are where the problems are documented.
"""

from collections.abc import Mapping
from typing import Any, Final

from service.api.derivation_kinds import KINDS
from service.api.examples import derivations, estimates, jobs, results, scans, whole_service

Examples = Mapping[str, Any]
"""Values by their names."""

_DERIVATIONS: Final[Examples] = {
    name: request for kind in KINDS.values() for name, request in kind.requests.items()
} | {"told-of-its-end": derivations.TOLD_OF_ITS_END}

_OF_SCANS: Final[Examples] = {
    name: request
    for kind in KINDS.values()
    if kind.of_scans
    for name, request in kind.requests.items()
}

_SHOWN: Final = ("report", "caricature", "pose", "combined", "figure", "texture", "animation")
"""The order of the first results in the document; those of other kinds follow."""

_DERIVED: Final[Examples] = {kind: KINDS[kind].answer for kind in dict.fromkeys((*_SHOWN, *KINDS))}

UPLOADED: Final = {"photograph": estimates.UPLOADED_IMAGE}

REQUESTS: Final[Mapping[str, Examples]] = {
    "submit": jobs.SUBMISSIONS,
    "derive": _DERIVATIONS,
    "submit_scan": scans.SUBMISSIONS,
    "make_token": {"for-one-customer": {"jobs": 2, "label": "customer-4711"}},
    "derive_of_scan": _OF_SCANS,
    "initial_pose": estimates.INITIAL_POSE_REQUESTS,
    "estimate_body": estimates.BODY_REQUESTS,
    "propose_points": estimates.POINTS_REQUESTS,
    "check_capture": estimates.CHECK_REQUESTS,
}

ANSWERS: Final[Mapping[str, Mapping[int, Examples]]] = {
    "submit": {200: jobs.ENDED, 202: jobs.ACCEPTED},
    "retry": {200: jobs.ENDED, 202: jobs.ACCEPTED},
    "list_fits": {200: {"first-page": jobs.PAGE}},
    "get_fit": {200: jobs.ACCEPTED | jobs.RUNNING | jobs.ENDED},
    "cancel": {200: {"canceled": jobs.CANCELED}, 202: {"stopping": jobs.STOPPING}},
    "follow": {200: {"short-fit": jobs.EVENTS}},
    "fit_request": {200: {"as-understood": jobs.OPTIONS}},
    "result": {200: {"man-by-point-light": results.RESULT}},
    "artifact": {200: {"result.json": results.RESULT}},
    "derive": {200: derivations.ENDED, 202: derivations.ACCEPTED},
    "retry_derivation": {200: derivations.ENDED, 202: derivations.ACCEPTED},
    "list_derivations": {200: {"only-page": derivations.PAGE}},
    "get_derivation": {200: derivations.ACCEPTED | derivations.ENDED},
    "cancel_derivation": {
        200: {"canceled": derivations.CANCELED},
        202: {"stopping": derivations.STOPPING},
    },
    "follow_derivation": {200: {"report": jobs.EVENTS}},
    "derivation_request": {200: derivations.UNDERSTOOD},
    "derivation_result": {200: _DERIVED},
    "derivation_artifact": {200: {"result.json": _DERIVED["report"]}},
    "submit_scan": {200: scans.ENDED, 202: scans.ACCEPTED, 422: scans.REFUSED},
    "retry_scan": {200: scans.ENDED, 202: scans.ACCEPTED},
    "list_scans": {200: {"first-page": scans.PAGE}},
    "get_scan": {200: scans.ACCEPTED | scans.UNDER_WAY | scans.ENDED},
    "cancel_scan": {200: {"canceled": scans.CANCELED}, 202: {"stopping": scans.STOPPING}},
    "follow_scan": {200: {"short-scan": scans.EVENTS}},
    "scan_request": {200: {"as-understood": scans.OPTIONS}},
    "scan_result": {200: {"front-and-side": scans.RESULT}},
    "scan_artifact": {200: {"result.json": scans.RESULT}},
    "derive_of_scan": {200: scans.DERIVATION_ENDED, 202: scans.DERIVATION_ACCEPTED},
    "retry_derivation_of_scan": {200: scans.DERIVATION_ENDED, 202: scans.DERIVATION_ACCEPTED},
    "list_derivations_of_scan": {200: {"only-page": scans.DERIVATION_PAGE}},
    "get_derivation_of_scan": {200: scans.DERIVATION_ACCEPTED | scans.DERIVATION_ENDED},
    "cancel_derivation_of_scan": {
        200: {"canceled": scans.DERIVATION_CANCELED},
        202: {"stopping": scans.DERIVATION_STOPPING},
    },
    "follow_derivation_of_scan": {200: {"caricature": jobs.EVENTS}},
    "derivation_request_of_scan": {200: _OF_SCANS},
    "derivation_result_of_scan": {200: {"caricature": _DERIVED["caricature"]}},
    "derivation_artifact_of_scan": {200: {"result.json": _DERIVED["caricature"]}},
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
