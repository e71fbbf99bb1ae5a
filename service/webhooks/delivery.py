"""A thread that sends notices that are due, and retries those that were not accepted."""

import asyncio
import base64
import hashlib
import hmac
import logging
import random
import threading
import time
from collections.abc import Sequence
from datetime import UTC, datetime
from functools import partial
from typing import Final

from api_schemas.jobs import WebhookState
from api_schemas.webhooks import WebhookEvent, WebhookEventType, secret_key
from service.blobs import BlobMissingError, BlobStore, BlobsUnavailableError
from service.engine.port import EngineUnavailableError, JobRecord
from service.engine.webhooks import DueWebhook, WebhookLedger
from service.process.logs import fields
from service.representation.jobs import represent
from service.webhooks.sending import Answer, Sender
from service.webhooks.targets import read_target

LOG: Final = logging.getLogger(__name__)

POLL_S: Final = 0.5
AT_ONCE: Final = 16
"""Concurrent attempts per process."""

JITTER: Final = 0.1
"""Pauses are longer by up to this share, so that what failed together is not repeated together."""

LONGEST_PAUSE_S: Final = 86_400.0
STORAGE_PAUSE_S: Final = 30.0
"""When to try again after the storage failed to say whom to notify."""

USER_AGENT: Final = "Maquette (Standard Webhooks)"


def notice(job: JobRecord) -> bytes:
    """Write the body of the notice of an ended fit; it is the same at every attempt."""
    event = WebhookEvent(
        type=WebhookEventType(f"fit.{job.state}"),
        timestamp=datetime.fromtimestamp(job.finished_at or 0.0, UTC),
        data=represent(job).model_copy(update={"webhook": None}),
    )
    return event.model_dump_json().encode()


class Deliverer:
    """Delivers at least once: an attempt whose process dies is made again after its lease.

    Several processes may do so on one database. ``pauses_s`` are the pauses between attempts, after
    which a notice is given up; ``secret`` signs if the caller sent none.
    """

    def __init__(
        self,
        ledger: WebhookLedger,
        sender: Sender,
        blobs: BlobStore,
        *,
        secret: str | None,
        pauses_s: Sequence[float],
    ) -> None:
        self._ledger = ledger
        self._sender = sender
        self._blobs = blobs
        self._secret = secret
        self._pauses_s = pauses_s
        self._stopped = threading.Event()
        self._thread = threading.Thread(
            target=lambda: asyncio.run(self._deliver()), name="webhooks", daemon=True
        )

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """Abort the attempts under way; they become due at once, for any process."""
        self._stopped.set()
        if self._thread.is_alive():
            self._thread.join()

    async def _deliver(self) -> None:
        under_way: set[asyncio.Task[None]] = set()
        while not self._stopped.is_set():
            for due in await self._claimed(AT_ONCE - len(under_way)):
                attempt = asyncio.create_task(self._attempt(due))
                under_way.add(attempt)
                attempt.add_done_callback(under_way.discard)
            await asyncio.sleep(POLL_S)
        for attempt in under_way:
            attempt.cancel()
        await asyncio.gather(*under_way, return_exceptions=True)

    async def _claimed(self, limit: int) -> Sequence[DueWebhook]:
        if limit == 0:
            return ()
        try:
            return await asyncio.to_thread(self._ledger.claim, limit)
        except EngineUnavailableError:
            LOG.warning("The database is not available; no notices are sent.")
        except Exception:
            LOG.exception("Looking for notices to send failed.")
        return ()

    async def _attempt(self, due: DueWebhook) -> None:
        try:
            try:
                answer = await self._send(due)
            except asyncio.CancelledError:
                await asyncio.to_thread(self._ledger.hand_back, due)
                raise
            except BlobsUnavailableError:
                LOG.warning("The storage is not available; a notice is sent later.")
                later = partial(self._ledger.hand_back, due, in_s=STORAGE_PAUSE_S)
                await asyncio.to_thread(later)
                return
            await asyncio.to_thread(self._settle, due, answer)
        except EngineUnavailableError:
            LOG.warning("The database is not available; a notice may be sent again.")
        except Exception:
            LOG.exception("Sending a notice failed.", extra=fields(job=due.job.id))

    async def _send(self, due: DueWebhook) -> Answer:
        try:
            target = await asyncio.to_thread(read_target, self._blobs, due.job)
        except BlobMissingError:
            target = None
        if target is None:
            return Answer(error="What the job was made of is gone.")
        secret = target.secret or self._secret
        if secret is None:
            return Answer(error="The service has no secret any more to sign with.")
        body = notice(due.job)
        headers = signed_headers(
            notice_id=due.job.id, timestamp=int(time.time()), body=body, secret=secret
        )
        return await self._sender.post(
            target.url,
            headers={"content-type": "application/json", "user-agent": USER_AGENT, **headers},
            body=body,
        )

    def _settle(self, due: DueWebhook, answer: Answer) -> None:
        again_in_s = self._pause_s(due.attempt, answer)
        if again_in_s is not None:
            state = WebhookState.DUE
        else:
            state = WebhookState.DELIVERED if answer.is_accepted else WebhookState.GIVEN_UP
        self._ledger.settle(
            due, state=state, status=answer.status, error=answer.error, again_in_s=again_in_s
        )
        LOG.log(
            logging.INFO if answer.is_accepted else logging.WARNING,
            "A notice was sent." if answer.is_accepted else "A notice was not accepted.",
            # Its address may hold a secret of the receiver's.
            extra=fields(
                job=due.job.id,
                attempt=due.attempt,
                webhook=state,
                error=answer.cause or answer.error,
            ),
        )

    def _pause_s(self, attempt: int, answer: Answer) -> float | None:
        """How long to wait after this attempt; None if there is to be no other."""
        if answer.is_accepted or answer.is_unwanted or attempt > len(self._pauses_s):
            return None
        planned_s = self._pauses_s[attempt - 1] * random.uniform(1.0, 1.0 + JITTER)
        return min(max(planned_s, answer.retry_after_s or 0.0), LONGEST_PAUSE_S * (1.0 + JITTER))


def signed_headers(*, notice_id: str, timestamp: int, body: bytes, secret: str) -> dict[str, str]:
    """Return the headers that identify, date and sign a notice; ``timestamp`` in epoch seconds."""
    content = f"{notice_id}.{timestamp}.".encode() + body
    signature = base64.b64encode(hmac.digest(secret_key(secret), content, hashlib.sha256)).decode()
    return {
        "webhook-id": notice_id,
        "webhook-timestamp": str(timestamp),
        "webhook-signature": f"v1,{signature}",
    }
