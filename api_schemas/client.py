"""A client of the HTTP API: send pictures, wait for the fit, take its result and files.

    with Maquette("http://127.0.0.1:8000") as maquette:
        fit = maquette.fit({"gender": "female", "height_m": 1.68}, Path("my.jpg"))
        result = maquette.result(maquette.wait_for(fit))

The service checks requests, and its refusals say which field is at fault; results are of the types
of this package. ``api_schemas/typescript`` is the same for TypeScript.
"""

import json
import time
from collections.abc import Callable, Mapping, Sequence
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final, Self, TypeVar

import httpx
from pydantic import BaseModel

from api_schemas.jobs import Fit, JobState
from api_schemas.problems import PROBLEM_MEDIA_TYPE, Problem
from api_schemas.results import FitResult

WAIT_S: Final = 30
"""How long an answer about a fit that was sent waits for its end."""

_POLL_S: Final = 1.0
_TIMEOUT_S: Final = 60.0
_ACTIVE: Final = (JobState.QUEUED, JobState.RUNNING)

Model = TypeVar("Model", bound=BaseModel)
Picture = Path | str | bytes
"""A file, by its path, or its content."""

Request = BaseModel | Mapping[str, Any]


class MaquetteError(Exception):
    """The service refused a call or does not answer, or a fit has no result.

    ``problem`` says why and what to do, ``status`` is that of HTTP; both are None where nothing
    answers.
    """

    def __init__(self, message: str, *, status: int | None, problem: Problem | None) -> None:
        super().__init__(message)
        self.status = status
        self.problem = problem


class Maquette:
    """The service at an address.

    Parameters
    ----------
    address
        As ``https://measure.example.org``.
    token
        A key, where the service asks for one.
    transport
        What sends the requests, in place of the network.
    """

    def __init__(
        self,
        address: str,
        *,
        token: str | None = None,
        transport: httpx.BaseTransport | None = None,
    ) -> None:
        headers = {} if token is None else {"Authorization": f"Bearer {token}"}
        self._client = httpx.Client(
            base_url=address, headers=headers, timeout=_TIMEOUT_S + WAIT_S, transport=transport
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Close its connections."""
        self._client.close()

    def fit(
        self,
        request: Request,
        *pictures: Picture,
        masks: Sequence[Picture] = (),
        idempotency_key: str | None = None,
    ) -> Fit:
        """Send one to six pictures, in the order of the request's ``views``; it may have ended.

        ``masks`` are none, or one for each picture, white on the person. The same key with the same
        content gives the same fit, however often it is sent.
        """
        asked = (
            request.model_dump_json(exclude_unset=True)
            if isinstance(request, BaseModel)
            else json.dumps(request)
        )
        files = [("request", ("request.json", asked.encode(), "application/json"))]
        for part, sent in (("image", pictures), ("mask", masks)):
            files += [(part, (part, _content(each), "application/octet-stream")) for each in sent]
        headers = {"Prefer": f"wait={WAIT_S}"}
        if idempotency_key is not None:
            headers["Idempotency-Key"] = idempotency_key
        return _read(Fit, self._call("POST", "/v1/fits", files=files, headers=headers))

    def wait_for(self, fit: Fit, *, on_progress: Callable[[Fit], None] = lambda _: None) -> Fit:
        """Return the fit once it has succeeded.

        Raises
        ------
        MaquetteError
            If it ended otherwise.
        """
        while fit.state in _ACTIVE:
            on_progress(fit)
            time.sleep(_POLL_S)
            fit = _read(Fit, self._call("GET", fit.links.self))
        if fit.state is not JobState.SUCCEEDED:
            raise _failure(
                fit.problem, HTTPStatus.CONFLICT, otherwise=f"The fit ended as {fit.state}."
            )
        return fit

    def result(self, fit: Fit, *, stages: bool = False) -> FitResult:
        """Return what a fit that succeeded has found; ``stages`` is empty unless asked for."""
        include = {"include": "stages"} if stages else {}
        answer = self._call("GET", f"{fit.links.self}/result", params=include)
        return _read(FitResult, answer)

    def file(self, fit: Fit, name: str) -> bytes:
        """Return one of its files, ``views/0/overlay.png`` or ``body_canonical.obj``."""
        return self._call("GET", f"{fit.links.self}/files/{name}").content

    def erase(self, fit: Fit) -> None:
        """Stop it if it runs, and erase its pictures and results."""
        self._call("DELETE", fit.links.self)

    def _call(self, method: str, path: str, **sent: Any) -> httpx.Response:
        try:
            answer = self._client.request(method, path, **sent)
        except httpx.TransportError as error:
            message = (
                f"{self._client.base_url} does not answer ({error}). Check the address, and that "
                "the service runs."
            )
            raise MaquetteError(message, status=None, problem=None) from error
        if answer.is_success:
            return answer
        is_problem = answer.headers.get("Content-Type", "").startswith(PROBLEM_MEDIA_TYPE)
        raise _failure(
            _read(Problem, answer) if is_problem else None,
            answer.status_code,
            otherwise=f"The service answered {answer.status_code}.",
        )


def _content(picture: Picture) -> bytes:
    return picture if isinstance(picture, bytes) else Path(picture).read_bytes()


def _read(kind: type[Model], answer: httpx.Response) -> Model:
    """What a later version of the service has added is passed over."""
    return kind.model_validate_json(answer.content, extra="ignore")


def _failure(problem: Problem | None, status: int, *, otherwise: str) -> MaquetteError:
    message = f"{problem.detail} {problem.remedy}".strip() if problem else otherwise
    return MaquetteError(message, status=problem.status if problem else status, problem=problem)
