"""``maquette serve``: the API in this process, a worker and estimators in others."""

import errno
import logging
import os
import signal
import socket
import sys
import threading
from collections.abc import Callable, Sequence
from typing import Final

from service.blobs import setting_of_storage
from service.commands.preflight import run_preflight
from service.engine.ballast import open_ballast
from service.process.disk import open_disk
from service.process.interpreter import PYTHON
from service.process.supervisor import SupervisedWorker
from service.process.tracing import start_tracing
from service.settings import PREFIX, SettingError, Settings
from service.startup.begin import UNUSABLE_SETTINGS

LOG: Final = logging.getLogger(__name__)

WORKER_COMMAND: Final = (*PYTHON, "-m", "service.worker")
ESTIMATOR_COMMAND: Final = (*PYTHON, "-m", "service.estimates")
STOP_MARGIN_S: Final = 5.0
"""How much longer than its drain time a worker gets before it is killed."""


def listen(settings: Settings) -> socket.socket:
    """Bind the API's address; port 0 takes a free one.

    Raises
    ------
    OSError
        If something else is listening there.
    SettingError
        If it is impossible to listen on the address.
    """
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # With the protocol given explicitly, asyncio sends what is written at once: otherwise each
    # response on a kept-alive connection would wait 40 ms for the acknowledgement of its headers.
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((settings.host, settings.port))
    except OSError as error:
        listener.close()
        if error.errno == errno.EADDRINUSE:
            raise
        reason = (
            f"it cannot be listened on port {settings.port} there ({error.strerror}); name an "
            "address of this machine, and a port above 1023"
        )
        raise SettingError(reason, name="host", value=settings.host) from error
    return listener


def serve(
    settings: Settings,
    listener: socket.socket,
    *,
    worker_command: Sequence[str] | None = WORKER_COMMAND,
    estimator_command: Sequence[str] | None = None,
    announce: Callable[[str], None] = LOG.info,
) -> int:
    """Serve until interrupted; without a ``worker_command`` the workers run elsewhere.

    The worker forks the estimators, unless there is none or an ``estimator_command`` is given.
    Uvicorn is told to stop by SIGINT or SIGTERM and lets open requests end first. Returns the exit
    status: that of unusable settings if the worker found them to be so.
    """
    worker = None

    def stop_before_serving(_number: int, _frame: object) -> None:
        sys.exit(_status(worker))

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, stop_before_serving)
    # All faults of the settings come to light before anything with the same settings is started.
    ballast = open_ballast(settings)
    ballast.make_room()
    blobs = run_preflight(settings)
    tracing = start_tracing(settings, role="api")
    environment = _environment(settings)
    if worker_command is not None:
        worker = SupervisedWorker(
            worker_command,
            environment=environment,
            stop_timeout_s=settings.drain_s + STOP_MARGIN_S,
            final_code=UNUSABLE_SETTINGS,
            # As if we had been told to stop.
            on_final_end=lambda: os.kill(os.getpid(), signal.SIGTERM),
        )
    # Imported while the worker starts: each takes a good part of a second.
    from service.api.app import create_app
    from service.api.server import ApiServer
    from service.engine.browser_tokens import StoredBrowserTokens
    from service.engine.database import open_database, prepare_database
    from service.engine.dbos_jobs import DbosJobEngine
    from service.engine.image_port import ImageQuota
    from service.engine.keys import KeyRing
    from service.engine.rate_tokens import RateTokens
    from service.engine.storage_identity import take_storage
    from service.engine.webhooks import WebhookLedger
    from service.estimates.pool import EstimatorPool
    from service.estimates.starting import by_command, by_passing_on, can_watch_processes
    from service.webhooks.delivery import Deliverer
    from service.webhooks.sending import Sender

    prepare_database(settings.system_database_url, sandbox=settings.sandbox)
    take_storage(settings.system_database_url, blobs, named=setting_of_storage(settings))
    ballast.fill()
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
        ballast=ballast,
    )
    webhooks = Deliverer(
        WebhookLedger(database, time_limit_s=settings.webhook_time_limit_s),
        Sender(
            allowed_hosts=settings.allowed_webhook_hosts,
            ports=settings.allowed_webhook_ports,
            time_limit_s=settings.webhook_time_limit_s,
        ),
        blobs,
        secret=settings.webhook_secret,
        pauses_s=settings.webhook_schedule_s,
    )
    if worker is not None and estimator_command is None and can_watch_processes():
        start = by_passing_on(worker.pass_on)
    else:
        start = by_command(estimator_command or ESTIMATOR_COMMAND, environment=environment)
    # Started last: what it does before it is ready would keep service and worker waiting.
    estimators = EstimatorPool(start, processes=settings.estimator_processes)
    draining = threading.Event()
    app = create_app(
        settings=settings,
        engine=engine,
        blobs=blobs,
        disk=open_disk(settings),
        estimator=estimators,
        keys=KeyRing(database),
        tokens=RateTokens(database, per_minute=settings.requests_per_minute),
        browser_tokens=StoredBrowserTokens(database),
        draining=draining,
    )
    server = ApiServer(
        app,
        log_level=settings.log_level,
        draining=draining,
        stop_delay_s=settings.stop_delay_s,
    )
    # The server handles signals while it runs, and raises them again when it is done: they must
    # not end the process before the worker is stopped.
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: setattr(server, "should_exit", True))
    host, port = listener.getsockname()[:2]
    announce(f"Maquette listens on http://{host}:{port}, documented at /docs.")
    if settings.sandbox:
        LOG.warning("This is a sandbox: its results are canned, whatever is sent.")
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
    return _status(worker)


def _status(worker: SupervisedWorker | None) -> int:
    return UNUSABLE_SETTINGS if worker is not None and worker.has_finally_ended else 0


def _environment(settings: Settings) -> dict[str, str]:
    """The environment of processes started from here: our settings, without misspelt ones."""
    others = {
        name: value for name, value in os.environ.items() if not name.upper().startswith(PREFIX)
    }
    return others | settings.environment()
