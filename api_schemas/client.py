"""A client of the HTTP API: have pictures fitted, take the result and its files, have more made.

    with Maquette("http://127.0.0.1:8000") as maquette:
        fit = maquette.fit({"gender": "female", "height_m": 1.68}, Path("my.jpg"))
        result = maquette.result(fit)
        posed = maquette.product(fit, {"kind": "pose", "pose": "sitting"})
        glb = maquette.file(posed, "body_reposed.glb")

The service checks requests, and its refusals say which field is at fault; answers are of the types
of this package. ``api_schemas/typescript`` is the same for TypeScript.
"""

import contextlib
import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final, Self, TypeVar

import httpx
from pydantic import BaseModel

from api_schemas.jobs import EventData, EventKind, Fit, JobState
from api_schemas.problems import PROBLEM_MEDIA_TYPE, Problem
from api_schemas.products import Product
from api_schemas.results import FitResult

_PAUSE_S: Final = 1
_TIMEOUT_S: Final = 60.0

Model = TypeVar("Model", bound=BaseModel)
Ended = TypeVar("Ended", Fit, Product)
Content = Path | str | bytes
"""A file, by its path, or its content."""

Request = BaseModel | Mapping[str, Any]


class MaquetteError(Exception):
    """The service refused a call or does not answer, or a fit or product failed.

    ``problem`` says why and what to do, ``status`` is that of HTTP; both are None where nothing
    answers.
    """

    def __init__(self, message: str, *, status: int | None, problem: Problem | None) -> None:
        super().__init__(message)
        self.status = status
        self.problem = problem


class Maquette:
    """The service at an address, with an API key where it asks for one.

    ``transport`` sends the requests in place of the network.
    """

    def __init__(
        self,
        address: str,
        *,
        key: str | None = None,
        transport: httpx.BaseTransport | None = None,
    ) -> None:
        headers = {} if key is None else {"Authorization": f"Bearer {key}"}
        self._client = httpx.Client(
            base_url=address, headers=headers, timeout=_TIMEOUT_S, transport=transport
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._client.close()

    def fit(
        self,
        request: Request,
        *pictures: Content,
        masks: Sequence[Content] = (),
        idempotency_key: str | None = None,
        on_progress: Callable[[EventData], None] = lambda _: None,
    ) -> Fit:
        """Have one to six pictures fitted, in the order of ``views``; returns the fit that is done.

        ``masks`` are none, or one for each picture, white on the person. The same key with the same
        content gives the same fit, however often it is sent.

        Raises
        ------
        MaquetteError
            If it is refused, or does not succeed.
        """
        form = _form(request, image=pictures, mask=masks)
        headers = {} if idempotency_key is None else {"Idempotency-Key": idempotency_key}
        fit = _read(Fit, self._call("POST", "/v1/fits", files=form, headers=headers))
        for event in self._events(fit):
            on_progress(event)
        return _succeeded(_read(Fit, self._call("GET", fit.links.self)))

    def result(self, fit: Fit) -> FitResult:
        """Return what a fit has found."""
        return _read(FitResult, self._call("GET", f"{fit.links.self}/result"))

    def product(
        self,
        fit: Fit,
        request: Request,
        *,
        on_progress: Callable[[Product], None] = lambda _: None,
        **part: Content,
    ) -> Product:
        """Have something made of a fit; ``part`` is what comes along, as ``chart=Path("a.csv")``.

        Raises as :meth:`fit` does.
        """
        form = _form(request, **{name: [each] for name, each in part.items()})
        path, headers = f"{fit.links.self}/products", {"Prefer": f"wait={_PAUSE_S}"}
        answer = self._call("POST", path, files=form, headers=headers)
        while (product := _read(Product, answer)).state in (JobState.QUEUED, JobState.RUNNING):
            on_progress(product)
            time.sleep(_PAUSE_S)
            answer = self._call("GET", product.links.self)
        return _succeeded(product)

    def file(self, of: Fit | Product, name: str) -> bytes:
        """Return a file of a fit or product, ``views/0/overlay.png`` or ``body_canonical.obj``."""
        return self._call("GET", f"{of.links.self}/files/{name}").content

    def erase(self, fit: Fit) -> None:
        """Erase a fit with its pictures, results and products."""
        self._call("DELETE", fit.links.self)

    def _events(self, fit: Fit) -> Iterator[EventData]:
        """Follow a fit to its end, over broken connections too."""
        seen, kind = "0", ""
        while kind != EventKind.END:
            headers = {"Last-Event-ID": seen}
            with (
                contextlib.suppress(httpx.TransportError),
                self._client.stream("GET", fit.links.events, headers=headers) as stream,
            ):
                if HTTPStatus.OK < stream.status_code < HTTPStatus.INTERNAL_SERVER_ERROR:
                    return
                for line in stream.iter_lines():
                    name, _, value = line.partition(": ")
                    seen = value if name == "id" else seen
                    kind = value if name == "event" else kind
                    if name == "data":
                        yield EventData.model_validate_json(value, extra="ignore")
            if kind != EventKind.END:
                time.sleep(_PAUSE_S)

    def _call(self, method: str, path: str, **sent: Any) -> httpx.Response:
        try:
            answer = self._client.request(method, path, **sent)
        except httpx.TransportError as error:
            message = f"{self._client.base_url} does not answer ({error}). Check the address."
            raise MaquetteError(message, status=None, problem=None) from error
        if answer.is_success:
            return answer
        is_problem = answer.headers.get("Content-Type", "").startswith(PROBLEM_MEDIA_TYPE)
        problem = _read(Problem, answer) if is_problem else None
        raise _failure(problem, answer.status_code, f"The service answered {answer.status_code}.")


def _form(request: Request, **files: Sequence[Content]) -> list[tuple[str, Any]]:
    read = [(name, _content(each)) for name, several in files.items() for each in several]
    parts = [("request", _json(request)), *read]
    return [(name, (name, content, "application/octet-stream")) for name, content in parts]


def _json(request: Request) -> bytes:
    if isinstance(request, BaseModel):
        return request.model_dump_json(exclude_unset=True).encode()
    return json.dumps(request).encode()


def _content(file: Content) -> bytes:
    return file if isinstance(file, bytes) else Path(file).read_bytes()


def _read(kind: type[Model], answer: httpx.Response) -> Model:
    """The answer as a model; fields that a later version of the service has added are ignored."""
    return kind.model_validate_json(answer.content, extra="ignore")


def _succeeded(ended: Ended) -> Ended:
    if ended.state is JobState.SUCCEEDED:
        return ended
    raise _failure(ended.problem, HTTPStatus.CONFLICT, f"It ended as {ended.state}.")


def _failure(problem: Problem | None, status: int, otherwise: str) -> MaquetteError:
    message = f"{problem.detail} {problem.remedy}".strip() if problem else otherwise
    return MaquetteError(message, status=problem.status if problem else status, problem=problem)
