"""The tasks of jobs: from the bytes that the worker has of one to the files that are its result."""

from collections.abc import Callable, Mapping
from typing import Final

from pydantic import TypeAdapter

from api_schemas.fit import FitRequest
from api_schemas.products import ProductRequest
from api_schemas.products.base import ProductResult
from service.compute.files import with_result_document
from service.compute.pipeline_port import Made, PipelineInput, PipelineOutput, ProductInput
from service.jobs.inputs import RESULT, pictures_of
from service.jobs.records import FIT
from service.numerics.tasks import ChildSetup, Observe, Parts, Task

PRODUCT: Final = "product"
"""The task of every product of a fit."""

OPTIONS: Final = "options"
"""The part that says what is asked for."""

STAGE_SECONDS: Final = "stage-seconds"
"""The part of a fit's answer that is no file of its result, but how long each stage took."""

SECONDS: Final[TypeAdapter[Mapping[str, float]]] = TypeAdapter(Mapping[str, float])

Run = Callable[[PipelineInput, Observe], PipelineOutput]
Make = Callable[[ProductInput, Observe], Made[ProductResult]]


def job_tasks(run: Run, make: Make) -> Mapping[str, Task]:
    """The table of a pipeline (:class:`service.compute.pipeline_port.Pipeline`)."""

    def fit(setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
        fitted = run(fit_input(setup, parts), observe)
        seconds = SECONDS.dump_json(fitted.result.stage_seconds)
        files = with_result_document(fitted.result, fitted.files)
        return {**files, STAGE_SECONDS: seconds}

    def product(setup: ChildSetup, parts: Parts, observe: Observe) -> Parts:
        made = make(product_input(setup, parts), observe)
        return {**made.files, RESULT: made.result.model_dump_json().encode()}

    return {FIT: fit, PRODUCT: product}


def fit_input(setup: ChildSetup, parts: Parts) -> PipelineInput:
    """The pictures of one person."""
    return PipelineInput(
        request=FitRequest.model_validate_json(parts[OPTIONS]),
        pictures=pictures_of(parts),
        max_pixels=setup.max_pixels,
        models=setup.models,
        detector=setup.detector,
    )


def product_input(setup: ChildSetup, parts: Parts) -> ProductInput:
    """What a fit left, and what came with the request."""
    return ProductInput(
        options=ProductRequest.model_validate_json(parts[OPTIONS]).root,
        files={name: part for name, part in parts.items() if name != OPTIONS},
        max_pixels=setup.max_pixels,
        models=setup.models,
    )
