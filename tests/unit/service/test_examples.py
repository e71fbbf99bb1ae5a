"""The recorded examples are of the wire types themselves, stricter than their schemas."""

import json

import pytest

from api_schemas.fit import FitRequest
from api_schemas.jobs import Fit, FitPage, WebhookEvent
from api_schemas.picture import ImagePage, UploadedImage
from api_schemas.problems import ProblemType
from api_schemas.products import Product, ProductRequest
from api_schemas.questions import (
    BodyEstimate,
    BodyRequest,
    InitialPose,
    InitialPoseRequest,
    PointsProposal,
    PointsRequest,
)
from api_schemas.results import FitResult
from api_schemas.service import BodyModels, Health
from service.api.openapi import recorded_examples

REQUESTS, ANSWERS, NOTICES = (
    recorded_examples()[name] for name in ("requests", "answers", "notices")
)
KINDS = {
    "submit_fit": Fit,
    "list_fits": FitPage,
    "get_fit": Fit,
    "cancel_fit": Fit,
    "get_fit_request": FitRequest,
    "get_fit_result": FitResult,
    "get_fit_file": FitResult,
    "make_product": Product,
    "get_product": Product,
    "upload_image": UploadedImage,
    "list_images": ImagePage,
    "get_image": UploadedImage,
    "estimate_initial_pose": InitialPose,
    "estimate_body": BodyEstimate,
    "propose_points": PointsProposal,
    "list_body_models": BodyModels,
    "get_liveness": Health,
    "get_readiness": Health,
    "get_problem_type": ProblemType,
}
TEXTS = {"follow_fit", "get_metrics"}


@pytest.mark.parametrize("operation", sorted(ANSWERS))
def test_examples_of_answers_are_of_their_types(operation):
    for examples in ANSWERS[operation].values() if operation not in TEXTS else ():
        for value in examples.values():
            KINDS[operation].model_validate_json(json.dumps(value))
    assert operation in KINDS.keys() | TEXTS


@pytest.mark.parametrize(
    ("operation", "kind"),
    [
        ("submit_fit", FitRequest),
        ("make_product", ProductRequest),
        ("estimate_initial_pose", InitialPoseRequest),
        ("estimate_body", BodyRequest),
        ("propose_points", PointsRequest),
    ],
)
def test_examples_of_requests_are_of_their_types(operation, kind):
    for value in REQUESTS[operation].values():
        kind.model_validate_json(json.dumps(value))


def test_the_example_of_a_notice_is_one():
    WebhookEvent.model_validate_json(json.dumps(NOTICES["fit-ended"]))
