"""``maquette serve``: the API in this process, a worker and estimators in others."""

import logging
import os
import signal
import socket
import sys
import threading
from collections.abc import Callable, Sequence
from typing import Final

from service.settings import Settings
from service.supervisor import SupervisedWorker

LOG: Final = logging.getLogger(__name__)

WORKER_COMMAND: Final = (sys.executable, "-m", "service.worker")
ESTIMATOR_COMMAND: Final = (sys.executable, "-m", "service.estimates")
STOP_MARGIN_S: Final = 5.0
"""What a worker gets beyond its drain time before it is killed."""


def listen(settings: Settings) -> socket.socket:
    """Bind the API's address; port 0 takes a free one."""
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # With its protocol named, asyncio sends what is written at once: else each answer over a kept
    # connection would wait for the acknowledgement of its headers, 40 ms.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((settings.host, settings.port))
    except OSError:
        listener.close()
        raise
    return listener


def serve(
    settings: Settings,
    listener: socket.socket,
    *,
    worker_command: Sequence[str] | None = WORKER_COMMAND,
    estimator_command: Sequence[str] = ESTIMATOR_COMMAND,
    announce: Callable[[str], None] = LOG.info,
) -> None:
    """Serve until interrupted; without a ``worker_command`` the workers run elsewhere.

    Uvicorn is told to stop by SIGINT or SIGTERM and lets open requests end first.
    """
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, _stop_before_serving)
    worker = None
    if worker_command is not None:
        worker = SupervisedWorker(
            worker_command,
            environment=os.environ | settings.environment(),
            stop_timeout_s=settings.drain_s + STOP_MARGIN_S,
        )
    # Imported while the others start: each takes a second or more to load.
    from service.estimates.pool import EstimatorPool

    estimators = EstimatorPool(
        estimator_command,
        environment=os.environ | settings.environment(),
        processes=settings.estimator_processes,
    )
    from service.api.app import create_app
    from service.api.server import ApiServer
    from service.blobs import open_blob_store
    from service.engine.database import open_database, prepare_database
    from service.engine.dbos_jobs import DbosJobEngine
    from service.engine.image_port import ImageQuota
    from service.engine.keys import KeyRing
    from service.engine.webhooks import WebhookLedger
    from service.tracing import start_tracing
    from service.webhooks.delivery import Deliverer
    from service.webhooks.sending import Sender

    tracing = start_tracing(settings, role="api")
    prepare_database(settings.system_database_url)
    blobs = open_blob_store(settings)
    database = open_database(settings.system_database_url)
    engine = DbosJobEngine(
        database,
        blobs,
        max_queued=settings.max_queued,
        max_queued_per_tenant=settings.tenant_queue_limit,
        image_quota=ImageQuota(
            images=settings.max_images_per_tenant, size=settings.max_image_bytes_per_tenant
        ),
        retention_s=settings.retention_s,
        sweep_interval_s=settings.sweep_interval_s,
        heartbeat_s=settings.heartbeat_s,
        dead_after_s=settings.dead_after_s,
    )
    webhooks = Deliverer(
        WebhookLedger(database, time_limit_s=settings.webhook_time_limit_s),
        Sender(
            allowed_hosts=settings.allowed_webhook_hosts,
            time_limit_s=settings.webhook_time_limit_s,
        ),
        secret=settings.webhook_secret,
        pauses_s=settings.webhook_schedule_s,
    )
    draining = threading.Event()
    app = create_app(
        settings=settings,
        engine=engine,
        blobs=blobs,
        estimator=estimators,
        keys=KeyRing(database),
        draining=draining,
    )
    server = ApiServer(
        app, log_level=settings.log_level, draining=draining, stop_delay_s=settings.stop_delay_s
    )
    # The server takes the signals while it runs, and raises them again when it is done: they must
    # not end the process before the worker is stopped.
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: setattr(server, "should_exit", True))
    host, port = listener.getsockname()[:2]
    announce(f"Maquette listens on http://{host}:{port}, documented at /docs.")
    engine.start()
    webhooks.start()
    try:
        server.run(sockets=[listener])
    finally:
        if worker is not None:
            worker.stop()
        estimators.stop()
        webhooks.stop()
        engine.close()
        tracing.stop()


def _stop_before_serving(_number: int, _frame: object) -> None:
    sys.exit(0)
