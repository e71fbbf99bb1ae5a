"""The parts of an API process, put together: settings in, a server with its helpers out.

Imported while the worker starts: what is below takes a second to import.
"""

import socket
import threading
from dataclasses import dataclass

import sqlalchemy as sa

from service.api.app import create_app
from service.api.server import ApiServer
from service.jobs.blobs import BlobStore, setting_of_storage
from service.jobs.database import open_database, prepare_database
from service.jobs.engine import JobEngine
from service.jobs.keys import KeyRing
from service.jobs.notices import NoticeRunner, Sender
from service.jobs.storage_identity import take_storage
from service.numerics.header_lane import header_lane
from service.numerics.quick_lane import Ask
from service.process.data_folder import open_disk
from service.representation.jobs import represent
from service.settings import Settings


@dataclass(frozen=True, slots=True, kw_only=True)
class ApiProcess:
    """What runs in an API process."""

    engine: JobEngine
    notices: NoticeRunner
    server: ApiServer

    def run(self, listener: socket.socket) -> None:
        """Serve until told to stop."""
        self.engine.start()
        self.notices.start()
        self.server.run(sockets=[listener])

    def ask_to_stop(self) -> None:
        """Have :meth:`run` return once open requests have ended."""
        self.server.should_exit = True

    def close(self) -> None:
        """Stop what runs beside the server."""
        self.notices.stop()
        self.engine.close()


def assemble(settings: Settings, blobs: BlobStore, ask: Ask) -> ApiProcess:
    """Prepare the database, and build all parts."""
    url = settings.system_database_url
    prepare_database(url)
    take_storage(url, blobs, named=setting_of_storage(settings))
    database = open_database(url)
    engine = _engine(settings, database, blobs)
    sender = Sender(
        blobs,
        represent,
        secret=settings.webhook_secret,
        allowed_hosts=settings.allowed_webhook_hosts,
    )
    draining = threading.Event()
    app = create_app(
        settings=settings,
        engine=engine,
        blobs=blobs,
        disk=open_disk(settings),
        ask=ask,
        read_header=header_lane(settings),
        keys=KeyRing(database),
        draining=draining,
    )
    server = ApiServer(
        app,
        log_level=settings.log_level,
        draining=draining,
        stop_delay_s=settings.stop_delay_s,
    )
    return ApiProcess(engine=engine, notices=NoticeRunner(database, sender.send), server=server)


def _engine(settings: Settings, database: sa.Engine, blobs: BlobStore) -> JobEngine:
    return JobEngine(
        database,
        blobs,
        max_queued=settings.max_queued,
        max_queued_per_tenant=settings.tenant_queue_limit,
        image_quota=settings.max_image_bytes_per_tenant,
        retention_s=settings.retention_s,
        sweep_interval_s=settings.sweep_interval_s,
        heartbeat_s=settings.heartbeat_s,
        dead_after_s=settings.dead_after_s,
    )
