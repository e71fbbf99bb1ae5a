"""Authentication, before the body is looked at: a key names a tenant.

Without keys only this machine's own pages and programs may ask. A service on a loopback address can
still be reached by every page open in a browser on the machine, in two ways: a site that resolves
its own name to 127.0.0.1 (its pages could then read answers), and a form that posts to us (its
pages could submit, though not read). The first shows in the Host header, the second in Origin.
"""

import time
from typing import Final
from urllib.parse import SplitResult, urlsplit

from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.types import ASGIApp, Receive, Scope, Send

from service.api.limits import RateLimit
from service.api.problems import ProblemError, problem_error, problem_response, unavailable
from service.jobs.keys import ApiKey, KeyRing, hash_key
from service.jobs.records import EngineUnavailableError
from service.settings import is_loopback

SOLE_TENANT: Final = "default"
"""The tenant of all jobs if no keys are required."""

OPEN: Final = ("/healthz/", "/problems/", "/docs", "/documentation", "/openapi.json", "/page/")
"""Prefixes of public paths: they show nothing that belongs to a tenant."""

ROOT: Final = "/"
"""The page, which asks the user for a key itself."""

METRICS_PATH: Final = "/metrics"
METRICS_TENANT: Final = "metrics"
"""Its keys open that path and nothing else, and no other keys do."""

HARMLESS: Final = frozenset({"GET", "HEAD", "OPTIONS"})

REFRESH_S: Final = 5.0
"""Within this time at the latest a key is refused that was revoked."""

RETRY_UNKNOWN_S: Final = 0.5
"""Unknown keys cause at most one query per this time, all of them together."""

KEY_REMEDY: Final = (
    "Send the header 'Authorization: Bearer' with a key; whoever runs the service makes one with: "
    "maquette keys create TENANT"
)


class KnownKeys:
    """The valid keys, kept for a few seconds so that a request costs no query."""

    def __init__(self, source: KeyRing) -> None:
        self._source = source
        self._by_hash: dict[str, ApiKey] = {}
        self._read_at: float | None = None

    def find(self, presented: str) -> ApiKey | None:
        """Return the valid key that was presented; None if there is no such key.

        Raises
        ------
        EngineUnavailableError
            If the database is unavailable and nothing is known yet.
        """
        secret_hash = hash_key(presented)
        fresh_s = REFRESH_S if secret_hash in self._by_hash else RETRY_UNKNOWN_S
        if self._read_at is None or time.monotonic() - self._read_at >= fresh_s:
            self._refresh()
        return self._by_hash.get(secret_hash)

    def _refresh(self) -> None:
        try:
            keys = self._source.all_keys()
        except EngineUnavailableError:
            # A key valid a moment ago is still accepted; the request itself will fail next.
            if self._read_at is None:
                raise
            return
        self._by_hash = {key.secret_hash: key for key in keys if key.revoked_at is None}
        self._read_at = time.monotonic()


class Authentication:
    """ASGI middleware: sets ``request.state.tenant``, or answers 401, 403 or 429."""

    def __init__(self, app: ASGIApp, *, keys: KeyRing, rate_limit: RateLimit) -> None:
        self._app = app
        self._keys = KnownKeys(keys)
        self._rate_limit = rate_limit

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on on behalf of its tenant."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        request = Request(scope)
        try:
            request.state.tenant = await self._tenant(request)
        except ProblemError as error:
            answer = problem_response(request, error.problem, error.headers)
            await answer(scope, receive, send)
            return
        except EngineUnavailableError as error:
            await unavailable(request, error)(scope, receive, send)
            return
        await self._app(scope, receive, send)

    async def _tenant(self, request: Request) -> str:
        path = request.url.path
        if path == ROOT or path.startswith(OPEN):
            return SOLE_TENANT
        scheme, _, presented = request.headers.get("authorization", "").partition(" ")
        if scheme.lower() != "bearer" or not presented.strip():
            raise _unauthorized(detail="There is no API key.")
        key = await run_in_threadpool(self._keys.find, presented.strip())
        if key is None:
            raise _unauthorized(detail="The API key is unknown or revoked.")
        if (key.tenant == METRICS_TENANT) != (path == METRICS_PATH):
            raise _forbidden(
                code="wrong-role",
                detail=f"{METRICS_PATH} and keys of the tenant '{METRICS_TENANT}' go together.",
                remedy="Use a key made for this purpose.",
                field="Authorization",
            )
        retry_after_s = self._rate_limit.take(key.id)
        if retry_after_s:
            raise _too_many(retry_after_s)
        return key.tenant


class LocalGuard:
    """ASGI middleware in place of keys: everybody on this machine is the sole tenant.

    Foreign hosts, and changes that foreign pages ask for, are answered 403.
    """

    def __init__(self, app: ASGIApp, *, allowed_origins: tuple[str, ...]) -> None:
        self._app = app
        self._allowed_origins = frozenset(allowed_origins)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on if it comes from here."""
        if scope["type"] == "http":
            request = Request(scope)
            request.state.tenant = SOLE_TENANT
            error = self._objection(request)
            if error is not None:
                await problem_response(request, error.problem)(scope, receive, send)
                return
        await self._app(scope, receive, send)

    def _objection(self, request: Request) -> ProblemError | None:
        host = request.headers.get("host", "")
        if not is_loopback(_split(f"//{host}").hostname or ""):
            return _forbidden(
                code="host-not-allowed",
                detail="Without API keys the service answers to names of this machine only.",
                remedy="Ask for 127.0.0.1 or localhost, or set MAQUETTE_AUTHENTICATION=keys.",
                field="Host",
            )
        origin = request.headers.get("origin")
        if request.method in HARMLESS or origin is None or origin in self._allowed_origins:
            return None
        if _split(origin).netloc == host:
            return None
        return _forbidden(
            code="origin-not-allowed",
            detail="A page of another origin asked for a change.",
            remedy="Name its origin in MAQUETTE_CORS_ORIGINS if it is yours.",
            field="Origin",
        )


def _split(address: str) -> SplitResult:
    """Split an address; one that is invalid, say with an unclosed bracket, has no parts."""
    try:
        return urlsplit(address)
    except ValueError:
        return urlsplit("")


def _unauthorized(*, detail: str) -> ProblemError:
    return problem_error(
        slug="unauthorized",
        detail=detail,
        remedy=KEY_REMEDY,
        field="Authorization",
        headers={"WWW-Authenticate": 'Bearer realm="maquette"'},
    )


def _forbidden(*, code: str, detail: str, remedy: str, field: str) -> ProblemError:
    return problem_error(slug="forbidden", code=code, detail=detail, remedy=remedy, field=field)


def _too_many(retry_after_s: int) -> ProblemError:
    return problem_error(
        slug="too-many-requests",
        code="rate-limit",
        detail="This key asks too often.",
        remedy="Wait for the seconds in Retry-After; follow events instead of polling.",
        headers={"Retry-After": str(retry_after_s)},
    )
