"""What a child process runs: a pipeline from a request to a result and its files.

A fit goes through ``run``, a product of one through ``make``.

The real one is :mod:`service.compute.pipeline`. It is handed around by its dotted name, because it
is imported in the child process only: the worker itself loads no numerics.
"""

import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, Protocol, TypeVar, cast

from api_schemas.fit import FitRequest
from api_schemas.problems import FieldProblem, field_problem
from api_schemas.products import AnyProductOptions
from api_schemas.products.base import ProductResult
from api_schemas.results import FitResult
from service.jobs.inputs import SentPicture
from service.jobs.records import Report
from service.numerics.tasks import ProblemError

Result_co = TypeVar("Result_co", bound=ProductResult, covariant=True)


@dataclass(frozen=True, slots=True, kw_only=True)
class PipelineInput:
    """A fit as it reaches the pipeline: named points, encoded pictures in the order of its views.

    ``models`` is the folder of the body models, None for those shipped with the package;
    ``detector`` that of the detector's weights, None for those of their package.
    """

    request: FitRequest
    pictures: tuple[SentPicture[bytes], ...]
    max_pixels: int
    models: Path | None = None
    detector: Path | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class PipelineOutput:
    """The result, whose list of files is still empty, and the files by name."""

    result: FitResult
    files: Mapping[str, bytes]


@dataclass(frozen=True, slots=True, kw_only=True)
class ProductInput:
    """What is to be made, and what of: the fit's files, and the part that came along, by name."""

    options: AnyProductOptions
    files: Mapping[str, bytes]
    max_pixels: int
    models: Path | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Made(Generic[Result_co]):
    """What there is to say of a product, and its files by name."""

    result: Result_co
    files: Mapping[str, bytes]


class UnusableInputError(ProblemError):
    """What the caller sent cannot be used."""

    def __init__(self, error: FieldProblem) -> None:
        super().__init__(field_problem("unusable-input", error))
        self.error = error


class Pipeline(Protocol):
    """A module with these two functions."""

    def run(self, job: PipelineInput, observe: Callable[[Report], None]) -> PipelineOutput:
        """Fit.

        Raises
        ------
        UnusableInputError
            If the input is at fault.
        """
        ...

    def make(self, product: ProductInput, observe: Callable[[Report], None]) -> Made[ProductResult]:
        """Make a product of a fit; raises as ``run`` does."""
        ...


def load_pipeline(module: str) -> Pipeline:
    """Import the pipeline of that dotted name."""
    return cast("Pipeline", importlib.import_module(module))
