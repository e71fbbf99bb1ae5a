"""One notice: whom it goes to, what it says, and the request that takes it there."""

import asyncio
import base64
import hashlib
import hmac
import logging
import ssl
import time
from collections.abc import Collection, Mapping
from datetime import UTC, datetime
from typing import Final

import httpx

from api_schemas.jobs import WebhookEvent, WebhookEventType, WebhookTarget, secret_key
from api_schemas.problems import FieldProblem
from service.blobs import BlobMissingError, BlobStore
from service.jobs.port import JobRecord
from service.process.logs import fields
from service.representation.jobs import represent
from service.settings import Settings
from service.submissions.refusal import refused
from service.webhooks.addresses import (
    PORTS,
    AddressRefusedError,
    IPAddress,
    is_port_refused,
    is_refused_outright,
    port_of,
    resolve,
)

LOG: Final = logging.getLogger(__name__)

ATTEMPT_WITHIN_S: Final = 15.0
CONNECT_WITHIN_S: Final = 5.0
USER_AGENT: Final = "Maquette (Standard Webhooks)"


class NotAcceptedError(Exception):
    """The receiver does not have the notice; the message names neither it nor its address."""


def check_webhook(target: WebhookTarget | None, settings: Settings) -> None:
    """Check address and secret; names are looked up only when a notice is sent.

    Raises
    ------
    RefusedError
        If no notice can be sent there, or it could not be signed.
    """
    if target is None:
        return
    try:
        url = httpx.URL(target.url)
    except httpx.InvalidURL as error:
        raise refused(
            FieldProblem(
                field="webhook.url",
                code="unusable-address",
                reason="This is no address of a web server.",
                remedy="Send an address such as https://example.org/hooks/maquette.",
            )
        ) from error
    if is_refused_outright(url.host, settings.allowed_webhook_hosts):
        raise refused(
            FieldProblem(
                field="webhook.url",
                code="address-not-public",
                reason="Notices are sent to public addresses only.",
                remedy="Name a public host; whoever runs the service may allow others by "
                "MAQUETTE_WEBHOOK_HOSTS.",
            )
        )
    if is_port_refused(url, settings.allowed_webhook_hosts):
        raise refused(
            FieldProblem(
                field="webhook.url",
                code="port-not-allowed",
                reason=f"Notices are not sent to port {port_of(url)}.",
                remedy=f"Receive them at port {' or '.join(map(str, PORTS))}; whoever runs the "
                "service may allow a host's others by MAQUETTE_WEBHOOK_HOSTS.",
            )
        )
    if target.secret is None and settings.webhook_secret is None:
        raise refused(
            FieldProblem(
                field="webhook.secret",
                code="missing",
                reason="This service has no secret of its own to sign notices with.",
                remedy="Send one; make it with: echo whsec_$(openssl rand -base64 32)",
            )
        )


def read_target(blobs: BlobStore, job: JobRecord) -> WebhookTarget | None:
    """Read whom to notify of a job's end; None if nobody.

    Raises
    ------
    BlobMissingError
        If the job was erased meanwhile.
    BlobsUnavailableError
        If the storage does not answer.
    """
    if job.webhook is None:
        return None
    return WebhookTarget.model_validate_json(blobs.get(job.id, job.webhook.digest))


def body_of(job: JobRecord) -> bytes:
    """Write the body of the notice of an ended fit; it is the same at every attempt."""
    event = WebhookEvent(
        type=WebhookEventType(f"fit.{job.state}"),
        timestamp=datetime.fromtimestamp(job.finished_at or 0.0, UTC),
        data=represent(job),
    )
    return event.model_dump_json().encode()


def signed_headers(*, notice_id: str, timestamp: int, body: bytes, secret: str) -> dict[str, str]:
    """Return the headers that identify, date and sign a notice; ``timestamp`` in epoch seconds."""
    content = f"{notice_id}.{timestamp}.".encode() + body
    signature = base64.b64encode(hmac.digest(secret_key(secret), content, hashlib.sha256)).decode()
    return {
        "webhook-id": notice_id,
        "webhook-timestamp": str(timestamp),
        "webhook-signature": f"v1,{signature}",
    }


class Sender:
    """Posts notices to public addresses, and to ``allowed_hosts`` wherever they are.

    Nothing of this process is sent along: no proxy, no cookies, no credentials. Redirects are not
    followed, and only the head of the answer is read. ``secret`` signs if the caller sent none.
    """

    def __init__(
        self,
        blobs: BlobStore,
        *,
        secret: str | None,
        allowed_hosts: Collection[str],
        tls: ssl.SSLContext | None = None,
    ) -> None:
        self._blobs = blobs
        self._secret = secret
        self._allowed_hosts = allowed_hosts
        self._tls = tls or httpx.create_ssl_context()

    async def send(self, job: JobRecord) -> None:
        """Tell of a job's end; a receiver that answers 410 is not asked again.

        Raises
        ------
        NotAcceptedError
            If the receiver does not accept it.
        BlobsUnavailableError
            If the storage does not say whom to notify.
        """
        try:
            target = await asyncio.to_thread(read_target, self._blobs, job)
        except BlobMissingError:
            target = None
        secret = None if target is None else target.secret or self._secret
        if target is None or secret is None:
            return
        body = body_of(job)
        signed = signed_headers(
            notice_id=job.id, timestamp=int(time.time()), body=body, secret=secret
        )
        headers = {"content-type": "application/json", "user-agent": USER_AGENT, **signed}
        status = await self.post(target.url, headers=headers, body=body)
        accepted = httpx.codes.is_success(status)
        if not accepted and status != httpx.codes.GONE:
            message = f"The receiver answered {status}."
            raise NotAcceptedError(message)
        # Its address may hold a secret of the receiver's.
        LOG.info("A notice was sent.", extra=fields(job=job.id, status=status))

    async def post(self, url: str, *, headers: Mapping[str, str], body: bytes) -> int:
        """Post, and return the receiver's status.

        Raises
        ------
        NotAcceptedError
            If there is no answer.
        """
        try:
            async with asyncio.timeout(ATTEMPT_WITHIN_S):
                return await self._post(httpx.URL(url), headers, body)
        except TimeoutError as error:
            message = f"No answer within {ATTEMPT_WITHIN_S:g} s."
            raise NotAcceptedError(message) from error
        except AddressRefusedError as error:
            raise NotAcceptedError(str(error)) from error
        except (httpx.HTTPError, httpx.InvalidURL, ssl.SSLError) as error:
            # By kind alone: the message may quote the address, or what is there.
            message = f"No connection, or none that lasted ({type(error).__name__})."
            raise NotAcceptedError(message) from None

    async def _post(self, url: httpx.URL, headers: Mapping[str, str], body: bytes) -> int:
        if is_port_refused(url, self._allowed_hosts):
            message = "Notices are not sent to the receiver's port."
            raise AddressRefusedError(message)
        *others, last = await resolve(url.raw_host.decode(), port_of(url), self._allowed_hosts)
        for address in others:
            try:
                return await self._post_to(address, url, headers, body)
            except (httpx.ConnectError, httpx.ConnectTimeout):
                continue
        return await self._post_to(last, url, headers, body)

    async def _post_to(
        self, address: IPAddress, url: httpx.URL, headers: Mapping[str, str], body: bytes
    ) -> int:
        async with (
            httpx.AsyncClient(
                verify=self._tls,
                trust_env=False,
                # Who calls limits all of it.
                timeout=httpx.Timeout(None, connect=CONNECT_WITHIN_S),
            ) as client,
            client.stream(
                "POST",
                url.copy_with(host=str(address)),
                content=body,
                headers={"host": url.netloc.decode(), **headers},
                # The certificate must be for the name, not for the address.
                extensions={"sni_hostname": url.raw_host.decode()},
            ) as response,
        ):
            return response.status_code
