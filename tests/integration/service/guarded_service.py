"""A service that asks for keys, and whoever calls it with one."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

import httpx
import pytest
import sqlalchemy as sa

from service.jobs.database import open_database, prepare_database
from service.jobs.keys import KeyRing
from tests.integration.service.conftest import fresh_machine
from tests.integration.service.harness import (
    Machine,
    Service,
    eventually,
    running_service,
)


@dataclass
class Guarded:
    """A service that asks for keys, and its database."""

    service: Service
    ring: KeyRing
    database: sa.Engine
    clients: ExitStack

    def caller(self, secret: str) -> Service:
        """The service as somebody with this key sees it."""
        client = httpx.Client(
            base_url=self.service.client.base_url,
            headers={"Authorization": f"Bearer {secret}"},
            timeout=self.service.client.timeout,
        )
        self.clients.enter_context(client)
        return Service(self.service.process, client, self.service.machine)

    def key(self, tenant: str = "shop") -> str:
        key = self.ring.create(tenant)
        caller = self.caller(key)
        eventually(lambda: caller.client.get("/v1/fits").status_code == 200, what="key known")
        return key


@pytest.fixture(scope="module", params=["sqlite", "postgres"])
def guarded(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Guarded]:
    with fresh_machine(request.param, tmp_path_factory.mktemp("guarded")) as machine:
        machine.settings = {"authentication": "keys"}
        with (
            opened(machine) as database,
            running_service(machine) as service,
            ExitStack() as clients,
        ):
            yield Guarded(service, KeyRing(database), database, clients)


@contextmanager
def opened(machine: Machine) -> Iterator[sa.Engine]:
    url = machine.database_url or f"sqlite:///{machine.data_dir / 'maquette.sqlite'}"
    prepare_database(url)
    database = open_database(url)
    yield database
    database.dispose()
