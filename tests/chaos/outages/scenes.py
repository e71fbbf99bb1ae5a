"""The faults that can be tried, each with the service it is tried on."""

import contextlib
import logging
import os
import tempfile
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from tests.chaos.outages.cable import HERE_ADDRESS, NETWORK, two_hosts
from tests.chaos.outages.course import Scene
from tests.chaos.outages.own_postgres import OwnPostgres, own_postgres
from tests.chaos.outages.storage_door import Manner, storage_door
from tests.deployment import Commands, Deployment
from tests.object_storage import CREDENTIALS, ObjectStorage, running_object_storage
from tests.small_disk import SmallDisk, small_disk

SETTINGS: Mapping[str, object] = {
    # The service's own, where a deployment that is only killed has quicker ones.
    "heartbeat_s": 2.0,
    "dead_after_s": 15.0,
    "max_crashes": 3,
    # Notices go to the run's own receiver, and are signed with a secret that is none.
    "webhook_hosts": "127.0.0.1",
    "webhook_secret": "whsec_" + "A" * 32,
}
DISK_MB = 400
RESERVE_MB = 30
POSTGRES_DISK_MB = 160
"""What an empty cluster takes, its log of 32 MB, and some room."""

SMALL_LOG = ("min_wal_size=32MB", "max_wal_size=32MB", "wal_recycle=off")
REFILLED_EVERY_S = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """How long it lasts, and how its scene is set in a folder."""

    seconds: float
    scene: Callable[[Path, Commands], AbstractContextManager[Scene]]


@contextlib.contextmanager
def _running(
    folder: Path,
    commands: Commands,
    *,
    database_url: str | None = None,
    workers: int = 1,
    settings: Mapping[str, object] | None = None,
    log_to: Path | None = None,
) -> Iterator[Deployment]:
    deployment = Deployment(
        folder=folder,
        commands=commands,
        database_url=database_url,
        settings={**SETTINGS, **(settings or {})},
        workers=workers,
        log_to=log_to,
    )
    try:
        deployment.start()
        yield deployment
    finally:
        deployment.end()


@contextlib.contextmanager
def _postgres(folder: Path, commands: Commands) -> Iterator[Scene]:
    with own_postgres() as server, _running(folder, commands, database_url=server.url) as running:
        yield Scene(deployment=running, begin=server.kill, end=server.start)


@contextlib.contextmanager
def _bucket(address: str = "127.0.0.1") -> Iterator[ObjectStorage]:
    os.environ.update(CREDENTIALS)
    # The server writes a line for every request.
    logging.getLogger("werkzeug").setLevel(logging.ERROR)
    with running_object_storage(address) as storage:
        place = {"LocationConstraint": storage.settings["aws_default_region"]}
        storage.client.create_bucket(Bucket=storage.bucket, CreateBucketConfiguration=place)
        yield storage


@contextlib.contextmanager
def _storage(folder: Path, commands: Commands, *, manner: Manner) -> Iterator[Scene]:
    with (
        own_postgres() as server,
        _bucket() as storage,
        storage_door(storage.endpoint_url) as door,
    ):
        behind = storage.settings | {"aws_endpoint_url_s3": door.endpoint_url}
        with _running(folder, commands, database_url=server.url, settings=behind) as running:
            yield Scene(deployment=running, begin=lambda: door.fail(manner), end=door.recover)


@contextlib.contextmanager
def _partition(folder: Path, commands: Commands) -> Iterator[Scene]:
    with (
        two_hosts() as cable,
        own_postgres(host=HERE_ADDRESS, reached_from=NETWORK) as server,
        _bucket(HERE_ADDRESS) as storage,
        _running(
            folder, commands, database_url=server.url, workers=0, settings=storage.settings
        ) as running,
    ):
        running.start_also(cable.command(*commands.worker))
        yield Scene(deployment=running, begin=cable.cut, end=cable.mend)


@contextlib.contextmanager
def _disk(folder: Path, commands: Commands) -> Iterator[Scene]:
    # The log is elsewhere: it is the service's disk that is full, not that of the journal.
    folder.mkdir(parents=True)
    with small_disk(folder / "disk", megabytes=DISK_MB) as disk:
        settings = {"min_free_disk_mb": RESERVE_MB}
        data = disk.folder / "data"
        with (
            _running(data, commands, settings=settings, log_to=folder / "log.txt") as running,
            _filling(disk) as (fill, clear),
        ):
            yield Scene(deployment=running, begin=fill, end=clear)


@contextlib.contextmanager
def _postgres_disk(folder: Path, commands: Commands) -> Iterator[Scene]:
    # Not in the run's folder, into which the server's user may not look.
    with (
        tempfile.TemporaryDirectory(prefix="maquette-postgres-") as mounted,
        small_disk(Path(mounted), megabytes=POSTGRES_DISK_MB) as disk,
        own_postgres(folder=disk.folder, options=SMALL_LOG) as server,
        _running(folder, commands, database_url=server.url) as running,
        _filling(disk, server) as (fill, clear),
    ):
        yield Scene(deployment=running, begin=fill, end=clear)


@contextlib.contextmanager
def _filling(
    disk: SmallDisk, server: OwnPostgres | None = None
) -> Iterator[tuple[Callable[[], None], Callable[[], None]]]:
    """Somebody who fills the disk and takes what becomes free, until told to clear it.

    A server on it that ends is started again, as an init system would.
    """
    stopped = threading.Event()

    def keep_full() -> None:
        while not stopped.wait(REFILLED_EVERY_S):
            disk.leave(0)
            if server is not None and not server.is_running:
                server.start_once()

    filler = threading.Thread(target=keep_full)

    def fill() -> None:
        disk.leave(0)
        filler.start()

    def clear() -> None:
        stopped.set()
        filler.join()
        disk.clear()
        if server is not None and not server.is_running:
            server.start()

    try:
        yield fill, clear
    finally:
        stopped.set()
        if filler.is_alive():
            filler.join()


FAULTS: Mapping[str, Fault] = {
    "postgres": Fault(seconds=20.0, scene=_postgres),
    "storage": Fault(seconds=30.0, scene=partial(_storage, manner=Manner.REFUSES)),
    "storage-503": Fault(seconds=30.0, scene=partial(_storage, manner=Manner.ANSWERS_503)),
    "partition": Fault(seconds=60.0, scene=_partition),
    "disk": Fault(seconds=30.0, scene=_disk),
    "postgres-disk": Fault(seconds=30.0, scene=_postgres_disk),
}
