"""The recorded examples are of the wire types themselves, stricter than their schemas."""

import json

import pytest

from api_schemas.bodies import BodyEstimate, BodyRequest
from api_schemas.body_models import BodyModels
from api_schemas.checks import CaptureCheck, CheckOfImage
from api_schemas.derivations import (
    Derivation,
    DerivationEvent,
    DerivationPage,
    DerivationRequest,
    DerivationResult,
)
from api_schemas.images import ImagePage, UploadedImage
from api_schemas.initial_poses import InitialPose, InitialPoseRequest
from api_schemas.jobs import Job, JobPage
from api_schemas.problems import ProblemType
from api_schemas.proposals import PointsOfImage, PointsProposal
from api_schemas.requests import FitOfImage, FitOptions
from api_schemas.results import FitResult
from api_schemas.scans import (
    Scan,
    ScanDerivation,
    ScanDerivationEvent,
    ScanDerivationPage,
    ScanEvent,
    ScanOfImages,
    ScanOptions,
    ScanPage,
    ScanResult,
)
from api_schemas.service import Live, Ready
from api_schemas.webhooks import WebhookEvent
from service.api.openapi import recorded_examples

REQUESTS, ANSWERS, NOTICES = (
    recorded_examples()[name] for name in ("requests", "answers", "notices")
)
KINDS = {
    "submit_fit": Job,
    "retry_fit": Job,
    "list_fits": JobPage,
    "get_fit": Job,
    "cancel_fit": Job,
    "get_fit_request": FitOptions,
    "get_fit_result": FitResult,
    "get_fit_artifact": FitResult,
    "submit_fit_derivation": Derivation,
    "retry_fit_derivation": Derivation,
    "list_fit_derivations": DerivationPage,
    "get_fit_derivation": Derivation,
    "cancel_fit_derivation": Derivation,
    "get_fit_derivation_request": DerivationRequest,
    "get_fit_derivation_result": DerivationResult,
    "get_fit_derivation_artifact": DerivationResult,
    "submit_scan": Scan,
    "retry_scan": Scan,
    "list_scans": ScanPage,
    "get_scan": Scan,
    "cancel_scan": Scan,
    "get_scan_request": ScanOptions,
    "get_scan_result": ScanResult,
    "get_scan_artifact": ScanResult,
    "submit_scan_derivation": ScanDerivation,
    "retry_scan_derivation": ScanDerivation,
    "list_scan_derivations": ScanDerivationPage,
    "get_scan_derivation": ScanDerivation,
    "cancel_scan_derivation": ScanDerivation,
    "get_scan_derivation_request": DerivationRequest,
    "get_scan_derivation_result": DerivationResult,
    "get_scan_derivation_artifact": DerivationResult,
    "upload_image": UploadedImage,
    "list_images": ImagePage,
    "get_image": UploadedImage,
    "estimate_initial_pose": InitialPose,
    "estimate_body": BodyEstimate,
    "propose_points": PointsProposal,
    "check_capture": CaptureCheck,
    "list_body_models": BodyModels,
    "get_liveness": Live,
    "get_readiness": Ready,
    "get_problem_type": ProblemType,
}
TEXTS = {
    "follow_fit",
    "follow_fit_derivation",
    "follow_scan",
    "follow_scan_derivation",
    "get_metrics",
}


@pytest.mark.parametrize("operation", sorted(ANSWERS))
def test_examples_of_answers_are_of_their_types(operation):
    for examples in ANSWERS[operation].values() if operation not in TEXTS else ():
        for value in examples.values():
            KINDS[operation].model_validate_json(json.dumps(value))
    assert operation in KINDS.keys() | TEXTS


@pytest.mark.parametrize(
    ("operation", "kind"),
    [
        ("submit_fit", FitOfImage),
        ("submit_fit_derivation", DerivationRequest),
        ("submit_scan", ScanOfImages),
        ("submit_scan_derivation", DerivationRequest),
        ("estimate_initial_pose", InitialPoseRequest),
        ("estimate_body", BodyRequest),
        ("propose_points", PointsOfImage),
        ("check_capture", CheckOfImage),
    ],
)
def test_examples_of_requests_are_of_their_types(operation, kind):
    for value in REQUESTS[operation].values():
        kind.model_validate_json(json.dumps(value))


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("fit-ended", WebhookEvent),
        ("derivation-ended", DerivationEvent),
        ("scan-ended", ScanEvent),
        ("scan-derivation-ended", ScanDerivationEvent),
    ],
)
def test_the_example_of_a_notice_is_one(name, kind):
    kind.model_validate_json(json.dumps(NOTICES[name]))
