"""Authentication: an API key names a tenant. It is checked before the body is looked at."""

from typing import Final

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from api_schemas.problems import problem
from service.api.body_limits import refuse
from service.api.context import SOLE_TENANT, Caller
from service.api.credentials import KeyUses, KnownKeys
from service.api.problems import ProblemError, problem_response
from service.api.rate_limit import RateLimit
from service.jobs.keys import ApiKey, Role
from service.jobs.records import EngineUnavailableError

OPEN: Final = ("/healthz/", "/problems/", "/docs", "/documentation", "/openapi.json", "/page/")
"""Prefixes of public paths: they show nothing that belongs to a tenant."""

ROOT: Final = "/"
"""The page, which asks the user for a key itself."""

METRICS_PATH: Final = "/metrics"

NO_KEY: Final = "There is no API key."
UNKNOWN_KEY: Final = "The API key is unknown or revoked."
KEY_REMEDY: Final = (
    "Send the header 'Authorization: Bearer' with a key; whoever runs the service makes one with: "
    "maquette keys create TENANT"
)


class Authentication:
    """ASGI middleware: sets ``request.state.caller``, or answers 401, 403 or 429.

    Without ``keys`` everybody is the sole tenant; the settings ensure that the service can then be
    reached only from its own machine. Without a ``rate_limit`` requests are not limited.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        keys: KnownKeys | None,
        uses: KeyUses,
        rate_limit: RateLimit | None,
    ) -> None:
        self._app = app
        self._keys = keys
        self._uses = uses
        self._rate_limit = rate_limit

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on on behalf of its tenant."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        try:
            request.state.caller = await self._caller(request)
        except ProblemError as error:
            await refuse(
                problem_response(request, error.problem, error.headers), scope, receive, send
            )
            return
        await self._app(scope, receive, send)

    async def _caller(self, request: Request) -> Caller:
        path = request.url.path
        if self._keys is None or path == ROOT or path.startswith(OPEN):
            return Caller(tenant=SOLE_TENANT)
        scheme, _, presented = request.headers.get("authorization", "").partition(" ")
        if scheme.lower() != "bearer" or not presented.strip():
            raise _unauthorized(NO_KEY)
        try:
            caller = await self._holder(self._keys, presented.strip(), path)
        except EngineUnavailableError as error:
            raise _not_ready() from error
        if caller.key_id is not None:
            self._uses.note(caller.key_id)
        if self._rate_limit is not None and caller.key_id is not None:
            retry_after_s = self._rate_limit.take(caller.key_id)
            if retry_after_s:
                raise _too_many(retry_after_s)
        return caller

    async def _holder(self, keys: KnownKeys, presented: str, path: str) -> Caller:
        key = await run_in_threadpool(keys.find, presented)
        if key is None:
            raise _unauthorized(UNKNOWN_KEY)
        for_metrics = path == METRICS_PATH
        if (key.role is Role.METRICS) != for_metrics:
            raise _forbidden(key)
        return Caller(tenant=key.tenant, key_id=key.id)


def _unauthorized(detail: str) -> ProblemError:
    return ProblemError(
        problem(
            "unauthorized",
            detail=detail,
            remedy=KEY_REMEDY,
            field="Authorization",
        ),
        headers={"WWW-Authenticate": 'Bearer realm="maquette"'},
    )


def _forbidden(key: ApiKey) -> ProblemError:
    return ProblemError(
        problem(
            "forbidden",
            code="wrong-role",
            detail=f"This key is for {key.role} only.",
            remedy="Use a key made for this purpose.",
            field="Authorization",
        )
    )


def _too_many(retry_after_s: int) -> ProblemError:
    return ProblemError(
        problem(
            "too-many-requests",
            code="rate-limit",
            detail="This key asks too often.",
            remedy="Wait for the seconds in Retry-After; follow events instead of polling.",
        ),
        headers={"Retry-After": str(retry_after_s)},
    )


def _not_ready() -> ProblemError:
    return ProblemError(
        problem(
            "not-ready",
            code="database-unavailable",
            detail="The API keys cannot be looked up at the moment.",
            remedy="Try again after the time in Retry-After.",
        )
    )
