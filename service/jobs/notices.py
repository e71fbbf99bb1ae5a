"""Notices of fits' ends, signed and sent to the receivers that callers named (Standard Webhooks).

Each is a workflow of DBOS, whose one step sends it and is retried by DBOS. It is enqueued in the
transaction that ends its fit, under an id made of the fit's, so none is lost and none is there
twice. API processes send them. One that dies leaves its notices to the next API process of its
machine; those of a machine that is gone are enqueued again by the sweep.

The caller chooses the address, and the service can reach what the caller cannot: notices go to
public addresses alone, and to hosts that the settings name. A name is resolved once, its addresses
are checked, and the connection goes to a checked one; a second look could give another.
"""

import asyncio
import base64
import hashlib
import hmac
import ipaddress
import logging
import os
import socket
import ssl
import time
from collections import defaultdict
from collections.abc import Awaitable, Callable, Collection, Mapping
from datetime import UTC, datetime, timedelta
from typing import Final

import httpx
import sqlalchemy as sa
from dbos import DBOS, DBOSClient, error

from api_schemas.jobs import Fit, WebhookEvent, WebhookEventType, WebhookTarget, secret_key
from api_schemas.problems import FieldProblem
from service.jobs.blobs import BlobMissingError, BlobStore
from service.jobs.executions import EXECUTION_VERSION, client_of, configure
from service.jobs.records import JobRecord
from service.jobs.rows import find_job
from service.process.logs import fields
from service.settings import Settings

IPAddress = ipaddress.IPv4Address | ipaddress.IPv6Address

LOG: Final = logging.getLogger(__name__)

QUEUE: Final = "notices"
WORKFLOW: Final = "notice"

POLL_S: Final = 0.5
FIRST_PAUSE_S: Final = 1.0
LONGER_BY: Final = 4.0
ATTEMPTS: Final = 8
"""With pauses of 1, 4, 16 ... seconds, none longer than an hour: the last attempt is 83 minutes
after the first."""

AT_ONCE: Final = 8
"""So many notices of one owner are on their way from a process at the same time: others' do not
wait for a receiver that does not answer, nor run out of connections because of it."""

LEFT_AFTER: Final = timedelta(hours=3)
"""By then a notice has been accepted or given up, unless whoever sent it is gone."""

ATTEMPT_WITHIN_S: Final = 15.0
CONNECT_WITHIN_S: Final = 5.0
USER_AGENT: Final = "Maquette (Standard Webhooks)"

GLOBAL_UNICAST: Final = ipaddress.IPv6Network("2000::/3")

SPECIAL: Final = tuple(
    map(
        ipaddress.ip_network,
        (
            # RFC 6890 and 7723: protocols between a host and its own network. The gateway answers
            # at 192.0.0.9, Oracle's metadata at 192.0.0.192.
            "192.0.0.0/24",
            # RFC 7535 and 7450: whichever name server or relay is nearest.
            "192.31.196.0/24",
            "192.52.193.0/24",
            "192.175.48.0/24",
            "2620:4f:8000::/48",
            # RFC 7526 and 3056: 6to4, whose relays are no more.
            "192.88.99.0/24",
            "2002::/16",
            # Azure's own services, from every machine in it, and from nowhere else.
            "168.63.129.16/32",
            # RFC 2928: Teredo, benchmarks, identifiers, the gateway at 2001:1::1.
            "2001::/23",
            # RFC 3849 and 9637: documentation.
            "2001:db8::/32",
            "3fff::/20",
            # RFC 3701: the testing network of before, given back.
            "3ffe::/16",
            # RFC 9602: segments of routes within one network.
            "5f00::/16",
        ),
    )
)
"""Networks that are not what a name on the open internet leads to, as IANA's registries of special
addresses have them. Python's own list depends on its release: it is asked as well."""


def notice_of(job_id: str) -> str:
    """The id of the workflow that tells of a job's end."""
    return f"{WORKFLOW}-{job_id}"


def enqueue_notice(client: DBOSClient, connection: sa.Connection, job: JobRecord) -> None:
    """Have the end of a job told, in the transaction that ends it, if anybody asked for it."""
    if job.webhook is not None:
        client.enqueue_in_transaction(
            connection,
            {
                "workflow_name": WORKFLOW,
                "queue_name": QUEUE,
                "workflow_id": notice_of(job.id),
                "app_version": EXECUTION_VERSION,
            },
            job.id,
        )


def enqueue_left(client: DBOSClient) -> None:
    """Enqueue again what processes that are gone have left."""
    latest = (datetime.now(UTC) - LEFT_AFTER).isoformat()
    left = client.list_workflows(
        name=WORKFLOW, status="PENDING", end_time=latest, load_input=False, load_output=False
    )
    for each in left:
        client.resume_workflow(each.workflow_id, queue_name=QUEUE)


def start_notices(database: sa.Engine, send: Callable[[JobRecord], Awaitable[None]]) -> None:
    """Begin to send what is enqueued, and what this machine's last API process left.

    ``send`` raises where a notice is not accepted.
    """
    # What is retried is a warning of its own.
    configure(database, executor_id=f"notices-{os.uname().nodename[:40]}", log_level="ERROR")
    turns = defaultdict[str, asyncio.Semaphore](lambda: asyncio.Semaphore(AT_ONCE))

    def find(job_id: str) -> JobRecord | None:
        with database.connect() as connection:
            return find_job(connection, job_id)

    @DBOS.step(
        name="send",
        retries_allowed=True,
        interval_seconds=FIRST_PAUSE_S,
        backoff_rate=LONGER_BY,
        max_attempts=ATTEMPTS,
    )
    async def attempt(job_id: str) -> None:
        job = await asyncio.to_thread(find, job_id)
        if job is not None:
            async with turns[job.tenant]:
                await send(job)

    @DBOS.workflow(name=WORKFLOW)
    async def notice(job_id: str) -> None:  # pyright: ignore[reportUnusedFunction]
        try:
            await attempt(job_id)
        except error.DBOSMaxStepRetriesExceeded:
            LOG.warning("A notice was given up.", extra=fields(job=job_id))

    DBOS.listen_queues([QUEUE])
    client_of(database).register_queue(QUEUE, polling_interval_sec=POLL_S)
    DBOS.launch()


def stop_notices() -> None:
    """Stop sending; what is under way is sent again."""
    DBOS.destroy()


class NotAcceptedError(Exception):
    """The receiver does not have the notice; the message names neither it nor its address."""


async def send_notice(
    job: JobRecord, *, blobs: BlobStore, represent: Callable[[JobRecord], Fit], settings: Settings
) -> None:
    """Tell of a job's end; a receiver that answers 410 is not asked again.

    ``represent`` is how callers see a fit. The service's secret signs if the caller sent none.

    Raises
    ------
    NotAcceptedError
        If the receiver does not accept it.
    BlobsUnavailableError
        If the storage does not say whom to notify.
    """
    if job.webhook is None:
        return
    try:
        stored = await asyncio.to_thread(blobs.get, job.id, job.webhook.digest)
    except BlobMissingError:
        # The job was erased meanwhile.
        return
    target = WebhookTarget.model_validate_json(stored)
    secret = target.secret or settings.webhook_secret
    if secret is None:
        return
    # The same at every attempt.
    event = WebhookEvent(
        type=WebhookEventType(f"fit.{job.state}"),
        timestamp=datetime.fromtimestamp(job.finished_at or 0.0, UTC),
        data=represent(job),
    )
    body = event.model_dump_json().encode()
    signed = signed_headers(notice_id=job.id, timestamp=int(time.time()), body=body, secret=secret)
    headers = {"content-type": "application/json", "user-agent": USER_AGENT, **signed}
    status = await post(target.url, headers, body, allowed_hosts=settings.webhook_hosts)
    if not httpx.codes.is_success(status) and status != httpx.codes.GONE:
        message = f"The receiver answered {status}."
        raise NotAcceptedError(message)
    # Its address may hold a secret of the receiver's.
    LOG.info("A notice was sent.", extra=fields(job=job.id, status=status))


async def post(
    url: str,
    headers: Mapping[str, str],
    body: bytes,
    *,
    allowed_hosts: Collection[str],
    tls: ssl.SSLContext | None = None,
) -> int:
    """Post to a public address, or to ``allowed_hosts`` wherever they are; return the status.

    Nothing of this process is sent along: no proxy, no cookies, no credentials. Redirects are not
    followed, and only the head of the answer is read.

    Raises
    ------
    NotAcceptedError
        If there is no answer.
    """
    try:
        parsed = httpx.URL(url)
        host = parsed.raw_host.decode()
        async with asyncio.timeout(ATTEMPT_WITHIN_S):
            address, *_ = await resolve(host, allowed_hosts)
            async with (
                httpx.AsyncClient(
                    verify=tls or httpx.create_ssl_context(),
                    trust_env=False,
                    # Who calls limits all of it.
                    timeout=httpx.Timeout(None, connect=CONNECT_WITHIN_S),
                ) as client,
                client.stream(
                    "POST",
                    parsed.copy_with(host=str(address)),
                    content=body,
                    headers={"host": parsed.netloc.decode(), **headers},
                    # The certificate must be for the name, not for the address.
                    extensions={"sni_hostname": host},
                ) as response,
            ):
                return response.status_code
    except TimeoutError as error:
        message = f"No answer within {ATTEMPT_WITHIN_S:g} s."
        raise NotAcceptedError(message) from error
    except (httpx.HTTPError, httpx.InvalidURL, ssl.SSLError) as error:
        # By kind alone: the message may quote the address, or what is there.
        message = f"No connection, or none that lasted ({type(error).__name__})."
        raise NotAcceptedError(message) from None


def signed_headers(*, notice_id: str, timestamp: int, body: bytes, secret: str) -> dict[str, str]:
    """Return the headers that identify, date and sign a notice; ``timestamp`` in epoch seconds."""
    content = f"{notice_id}.{timestamp}.".encode() + body
    signature = base64.b64encode(hmac.digest(secret_key(secret), content, hashlib.sha256)).decode()
    return {
        "webhook-id": notice_id,
        "webhook-timestamp": str(timestamp),
        "webhook-signature": f"v1,{signature}",
    }


def is_public(address: IPAddress) -> bool:
    """Whether an address is on the open internet, and no translation of another one."""
    if not address.is_global or address.is_multicast or any(address in each for each in SPECIAL):
        return False
    return address.version == 4 or address in GLOBAL_UNICAST


def target_fault(target: WebhookTarget, settings: Settings) -> FieldProblem | None:
    """Why no notice can be sent there or signed; None if one can, as far as the request says.

    Names are looked up only when a notice is sent.
    """
    try:
        url = httpx.URL(target.url)
    except httpx.InvalidURL:
        return FieldProblem(
            field="webhook.url",
            code="unusable-address",
            reason="This is no address of a web server.",
            remedy="Send an address such as https://example.org/hooks/maquette.",
        )
    if is_refused_outright(url.host, settings.webhook_hosts):
        return FieldProblem(
            field="webhook.url",
            code="address-not-public",
            reason="Notices are sent to public addresses only.",
            remedy="Name a public host; whoever runs the service may allow others by "
            "MAQUETTE_WEBHOOK_HOSTS.",
        )
    if target.secret is None and settings.webhook_secret is None:
        return FieldProblem(
            field="webhook.secret",
            code="missing",
            reason="This service has no secret of its own to sign notices with.",
            remedy="Send one; make it with: echo whsec_$(openssl rand -base64 32)",
        )
    return None


def is_refused_outright(host: str, allowed_hosts: Collection[str]) -> bool:
    """Whether a host can be refused without resolving it: a literal address, or localhost."""
    if host in allowed_hosts:
        return False
    try:
        return not is_public(ipaddress.ip_address(host))
    except ValueError:
        return host == "localhost" or host.endswith(".localhost")


async def resolve(host: str, allowed_hosts: Collection[str]) -> list[IPAddress]:
    """Resolve a host and return the addresses a notice may go to, at least one.

    Raises
    ------
    NotAcceptedError
        If there is none. It says nothing of the name: callers could find out by it which names
        exist in the service's network.
    """
    try:
        found = await asyncio.get_running_loop().getaddrinfo(host, None, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError) as error:
        message = "The receiver's name cannot be resolved."
        raise NotAcceptedError(message) from error
    # An IPv6 address may come with its zone.
    addresses = [ipaddress.ip_address(str(entry[4][0]).partition("%")[0]) for entry in found]
    if host not in allowed_hosts:
        addresses = [address for address in addresses if is_public(address)]
    if not addresses:
        message = "The receiver's address is not public."
        raise NotAcceptedError(message)
    return list(dict.fromkeys(addresses))
