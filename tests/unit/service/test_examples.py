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
from api_schemas.images import UploadedImage
from api_schemas.initial_poses import InitialPose, InitialPoseRequest
from api_schemas.jobs import Job, JobPage
from api_schemas.problems import ProblemType
from api_schemas.proposals import PointsOfImage, PointsProposal
from api_schemas.requests import FitOfImage, FitOptions
from api_schemas.results import FitResult
from api_schemas.webhooks import WebhookEvent
from service.api.operation_examples import ANSWERS, DERIVATION_NOTICE, NOTICE, REQUESTS

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
    "upload_image": UploadedImage,
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
TEXTS = {"follow", "follow_derivation", "metrics"}


@pytest.mark.parametrize("operation", sorted(ANSWERS))
def test_examples_of_answers_are_of_their_types(operation):
    for examples in ANSWERS[operation].values() if operation not in TEXTS else ():
        for value in examples.values():
            KINDS[operation].model_validate_json(json.dumps(value))
    assert operation in KINDS.keys() | TEXTS


@pytest.mark.parametrize(
    ("operation", "kind"),
    [
        ("submit", FitOfImage),
        ("derive", DerivationRequest),
        ("initial_pose", InitialPoseRequest),
        ("estimate_body", BodyRequest),
        ("propose_points", PointsOfImage),
        ("check_capture", CheckOfImage),
    ],
)
def test_examples_of_requests_are_of_their_types(operation, kind):
    for value in REQUESTS[operation].values():
        kind.model_validate_json(json.dumps(value))


def test_the_example_of_a_notice_is_one():
    WebhookEvent.model_validate_json(json.dumps(NOTICE))
    DerivationEvent.model_validate_json(json.dumps(DERIVATION_NOTICE))
