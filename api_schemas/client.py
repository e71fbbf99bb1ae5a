"""A client of the HTTP API: send pictures, wait for the job, take its result and files.

    with Maquette("http://127.0.0.1:8000") as maquette:
        job = maquette.fit(Path("my.jpg"), {"gender": "female", "height_m": 1.68, "points": "auto"})
        result = maquette.result(maquette.wait_for(job))

The service checks requests, and its refusals say which field is at fault; results are of the types
of this package. ``api_schemas/typescript`` is the same for TypeScript.
"""

import json
import time
from collections.abc import Callable, Mapping, Sequence
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final, Self, TypeVar, overload

import httpx
from pydantic import BaseModel

from api_schemas.jobs import Job, JobState
from api_schemas.problems import PROBLEM_MEDIA_TYPE, Problem
from api_schemas.results import FitResult
from api_schemas.scans import Scan, ScanResult

WAIT_S: Final = 30
"""How long an answer about a job that was sent waits for its end."""

_POLL_S: Final = 1.0
_TIMEOUT_S: Final = 60.0
_ACTIVE: Final = (JobState.QUEUED, JobState.RUNNING)

AnyJob = TypeVar("AnyJob", Job, Scan)
Model = TypeVar("Model", bound=BaseModel)
Picture = Path | str | bytes
"""A file, by its path, or its content."""

Request = BaseModel | Mapping[str, Any]


class MaquetteError(Exception):
    """The service refused a call or does not answer, or a job has no result.

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
        picture: Picture,
        request: Request,
        *,
        mask: Picture | None = None,
        idempotency_key: str | None = None,
    ) -> Job:
        """Send one picture, and a mask that is white on the person; the job may have ended.

        The same key with the same content gives the same job, however often it is sent.
        """
        parts = {"image": picture, "mask": mask}
        return self._send("/v1/fits", parts, request, Job, idempotency_key)

    def scan(
        self,
        pictures: Sequence[Picture],
        request: Request,
        *,
        masks: Sequence[Picture | None] = (),
        idempotency_key: str | None = None,
    ) -> Scan:
        """Send two to six pictures of one person, in the order of the request's ``views``.

        ``masks`` are in the same order, None for pictures without one; the key as for a fit.
        """
        parts = {f"image_{number}": picture for number, picture in enumerate(pictures)}
        parts |= {f"mask_{number}": mask for number, mask in enumerate(masks)}
        return self._send("/v1/scans", parts, request, Scan, idempotency_key)

    def wait_for(
        self, job: AnyJob, *, on_progress: Callable[[AnyJob], None] = lambda _: None
    ) -> AnyJob:
        """Return the job once it has succeeded.

        Raises
        ------
        MaquetteError
            If it ended otherwise.
        """
        while job.state in _ACTIVE:
            on_progress(job)
            time.sleep(_POLL_S)
            job = _read(type(job), self._call("GET", job.links.self))
        if job.state is not JobState.SUCCEEDED:
            raise _failure(
                job.problem, HTTPStatus.CONFLICT, otherwise=f"The job ended as {job.state}."
            )
        return job

    @overload
    def result(self, job: Job, *, stages: bool = False) -> FitResult: ...
    @overload
    def result(self, job: Scan, *, stages: bool = False) -> ScanResult: ...
    def result(self, job: Job | Scan, *, stages: bool = False) -> FitResult | ScanResult:
        """Return what a job that succeeded has found; ``stages`` is empty unless asked for."""
        include = {"include": "stages"} if stages else {}
        answer = self._call("GET", f"{job.links.self}/result", params=include)
        return _read(FitResult if isinstance(job, Job) else ScanResult, answer)

    def artifact(self, job: Job | Scan, name: str) -> bytes:
        """Return one of its files, ``overlay.png`` or ``body_posed.obj``."""
        return self._call("GET", f"{job.links.self}/artifacts/{name}").content

    def erase(self, job: Job | Scan) -> None:
        """Stop it if it runs, and erase its pictures and results."""
        self._call("DELETE", job.links.self)

    def _send(
        self,
        path: str,
        pictures: Mapping[str, Picture | None],
        request: Request,
        kind: type[Model],
        idempotency_key: str | None,
    ) -> Model:
        asked = (
            request.model_dump_json(exclude_unset=True)
            if isinstance(request, BaseModel)
            else json.dumps(request)
        )
        files = {"request": ("request.json", asked.encode(), "application/json")}
        for name, picture in pictures.items():
            if picture is not None:
                content = picture if isinstance(picture, bytes) else Path(picture).read_bytes()
                files[name] = (name, content, "application/octet-stream")
        headers = {"Prefer": f"wait={WAIT_S}"}
        if idempotency_key is not None:
            headers["Idempotency-Key"] = idempotency_key
        return _read(kind, self._call("POST", path, files=files, headers=headers))

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


def _read(kind: type[Model], answer: httpx.Response) -> Model:
    """What a later version of the service has added is passed over."""
    return kind.model_validate_json(answer.content, extra="ignore")


def _failure(problem: Problem | None, status: int, *, otherwise: str) -> MaquetteError:
    message = f"{problem.detail} {problem.remedy}".strip() if problem else otherwise
    return MaquetteError(message, status=problem.status if problem else status, problem=problem)
