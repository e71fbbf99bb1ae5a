"""One range of heights for every request, the fitter's and the page's too."""

from collections.abc import Iterator

import pytest
from pydantic import BaseModel, TypeAdapter, ValidationError

from api_schemas import fit, person, questions
from api_schemas.service import BodyModels
from fitter.vocabulary.measurements import LEAST_HEIGHT_M, MOST_HEIGHT_M
from service.api.openapi import complete_openapi
from service.submissions.refusal import field_problems

MODULES = (fit, questions)


def requests_with_a_height() -> Iterator[type[BaseModel]]:
    """Every type of a request that may name a height."""
    for module in MODULES:
        for kind in vars(module).values():
            if not (isinstance(kind, type) and issubclass(kind, BaseModel)):
                continue
            field = kind.model_fields.get("height_m")
            # Results always have one.
            if field is not None and not field.is_required():
                yield kind


def fault_of(kind: type[BaseModel], height_m: float) -> list[tuple[str, str]]:
    """The fault of a request's height, by field and code; other fields are missing."""
    try:
        kind.model_validate({"height_m": height_m})
    except ValidationError as error:
        problems, _ = field_problems(error.errors())
        return [(each.field, each.code) for each in problems if each.field == "height_m"]
    return []


def test_fits_bodies_poses_and_points_name_heights():
    assert {kind.__name__ for kind in requests_with_a_height()} >= {
        "BodyRequest", "FitRequest", "InitialPoseRequest", "PointsRequest",
    }  # fmt: skip


@pytest.mark.parametrize("kind", sorted(set(requests_with_a_height()), key=str))
def test_every_request_takes_the_same_heights_and_refuses_others_alike(kind):
    for height_m in (LEAST_HEIGHT_M, 1.7, MOST_HEIGHT_M):
        assert fault_of(kind, height_m) == []
    for height_m in (LEAST_HEIGHT_M - 0.01, MOST_HEIGHT_M + 0.01, 69.0, 170.0):
        assert fault_of(kind, height_m) == [("height_m", "out-of-range")]


def test_heights_of_children_are_refused_as_such():
    with pytest.raises(ValidationError) as caught:
        questions.PointsRequest.model_validate({"height_m": 1.1})
    ((problem,), _) = field_problems(caught.value.errors())
    assert "grown-up" in problem.reason
    assert "grown-up" in problem.remedy


def test_the_range_is_that_of_body_models_and_that_of_the_contract():
    range_m = (LEAST_HEIGHT_M, MOST_HEIGHT_M)
    stated = BodyModels(models=())
    document = complete_openapi({"paths": {}, "components": {"schemas": {}}})
    limits = document["x-limits"]["height_m"]
    assert (stated.min_height_m, stated.max_height_m) == range_m
    assert (limits["least"], limits["most"]) == range_m
    schema = TypeAdapter(person.HeightM).json_schema()
    assert (schema["minimum"], schema["maximum"]) == range_m
