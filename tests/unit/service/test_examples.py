"""The documented examples are of the wire types themselves, stricter than their schemas."""

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
from api_schemas.health import Live, Ready
from api_schemas.images import ImagePage, UploadedImage
from api_schemas.initial_poses import InitialPose, InitialPoseRequest
from api_schemas.jobs import Job, JobPage
from api_schemas.people import PeoplePage
from api_schemas.problems import Problem, ProblemType
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
from api_schemas.tokens import NewToken, Token, TokenPage, TokenRequest
from api_schemas.webhooks import WebhookEvent
from service.api.operation_examples import (
    ANSWERS,
    DERIVATION_NOTICE,
    NOTICE,
    REQUESTS,
    SCAN_DERIVATION_NOTICE,
    SCAN_NOTICE,
)

KINDS = {
    "submit": Job,
    "retry": Job,
    "list_fits": JobPage,
    "get_fit": Job,
    "cancel": Job,
    "fit_request": FitOptions,
    "result": FitResult,
    "artifact": FitResult,
    "derive": Derivation,
    "retry_derivation": Derivation,
    "list_derivations": DerivationPage,
    "get_derivation": Derivation,
    "cancel_derivation": Derivation,
    "derivation_request": DerivationRequest,
    "derivation_result": DerivationResult,
    "derivation_artifact": DerivationResult,
    "submit_scan": Scan,
    "retry_scan": Scan,
    "list_scans": ScanPage,
    "list_people": PeoplePage,
    "make_token": NewToken,
    "list_tokens": TokenPage,
    "get_token": Token,
    "get_scan": Scan,
    "cancel_scan": Scan,
    "scan_request": ScanOptions,
    "scan_result": ScanResult,
    "scan_artifact": ScanResult,
    "derive_of_scan": ScanDerivation,
    "retry_derivation_of_scan": ScanDerivation,
    "list_derivations_of_scan": ScanDerivationPage,
    "get_derivation_of_scan": ScanDerivation,
    "cancel_derivation_of_scan": ScanDerivation,
    "derivation_request_of_scan": DerivationRequest,
    "derivation_result_of_scan": DerivationResult,
    "derivation_artifact_of_scan": DerivationResult,
    "upload_image": UploadedImage,
    "list_images": ImagePage,
    "get_image": UploadedImage,
    "initial_pose": InitialPose,
    "estimate_body": BodyEstimate,
    "propose_points": PointsProposal,
    "check_capture": CaptureCheck,
    "body_models": BodyModels,
    "live": Live,
    "ready": Ready,
    "problem_type": ProblemType,
}
TEXTS = {
    "follow",
    "follow_derivation",
    "follow_scan",
    "follow_derivation_of_scan",
    "metrics",
}
REFUSED = 400
"""Answers from this status on are problems, whatever the operation."""


@pytest.mark.parametrize("operation", sorted(ANSWERS))
def test_examples_of_answers_are_of_their_types(operation):
    for status, examples in ANSWERS[operation].items() if operation not in TEXTS else ():
        kind = KINDS[operation] if status < REFUSED else Problem
        for value in examples.values():
            kind.model_validate_json(json.dumps(value))
    assert operation in KINDS.keys() | TEXTS


@pytest.mark.parametrize(
    ("operation", "kind"),
    [
        ("submit", FitOfImage),
        ("derive", DerivationRequest),
        ("submit_scan", ScanOfImages),
        ("derive_of_scan", DerivationRequest),
        ("initial_pose", InitialPoseRequest),
        ("estimate_body", BodyRequest),
        ("propose_points", PointsOfImage),
        ("check_capture", CheckOfImage),
        ("make_token", TokenRequest),
    ],
)
def test_examples_of_requests_are_of_their_types(operation, kind):
    for value in REQUESTS[operation].values():
        kind.model_validate_json(json.dumps(value))


def test_the_example_of_a_notice_is_one():
    WebhookEvent.model_validate_json(json.dumps(NOTICE))
    DerivationEvent.model_validate_json(json.dumps(DERIVATION_NOTICE))
    ScanEvent.model_validate_json(json.dumps(SCAN_NOTICE))
    ScanDerivationEvent.model_validate_json(json.dumps(SCAN_DERIVATION_NOTICE))
