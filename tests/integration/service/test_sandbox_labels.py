"""What a sandbox is asked for by a label: whose label counts, and where it is none."""

import json
from collections.abc import Iterator
from contextlib import ExitStack
from typing import Any

import pytest
import sqlalchemy as sa

from service.engine.keys import KeyRing
from service.engine.tables import JOBS
from service.jobs.inputs import SANDBOX
from tests.integration.service.guarded_service import Guarded, fit, made, opened
from tests.integration.service.harness import REQUEST, Machine, Service, running_service
from tests.integration.service.test_bad_input import checked


@pytest.fixture(scope="module")
def sandbox(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    """The API of a sandbox that asks for keys; what its jobs do is nobody's concern here."""
    machine = Machine(
        tmp_path_factory.mktemp("sandbox"),
        settings={"authentication": "keys", "sandbox": True},
    )
    with opened(machine) as database, running_service(machine) as service, ExitStack() as clients:
        yield Guarded(service, KeyRing(database), database, clients)


def inputs_of(sandbox: Guarded, path: str) -> dict[str, Any]:
    query = sa.select(JOBS.c.inputs).where(JOBS.c.id == path.rpartition("/")[2])
    with sandbox.database.connect() as connection:
        return json.loads(connection.execute(query).scalar_one())


def test_a_tokens_label_asks_and_not_that_of_the_request(sandbox: Guarded):
    holder = sandbox.caller(sandbox.key())
    asking = sandbox.caller(made(holder, label="sandbox:person-not-found").token)
    assert SANDBOX in inputs_of(sandbox, fit(asking, label="customer-1"))
    quiet = sandbox.caller(made(holder, label="customer-4711").token)
    assert SANDBOX not in inputs_of(sandbox, fit(quiet, label="sandbox:person-not-found"))
    without = sandbox.caller(made(holder).token)
    assert SANDBOX in inputs_of(sandbox, fit(without, label="sandbox:person-not-found"))


def test_no_token_is_made_that_asks_for_what_there_is_not(sandbox: Guarded):
    holder = sandbox.caller(sandbox.key())
    answer = holder.client.post("/v1/tokens", json={"label": "sandbox:nonsense"})
    assert checked(answer, 422).code == "unknown-ending"


def test_a_retry_is_not_asked_for_it_again(sandbox: Guarded):
    holder = sandbox.caller(sandbox.key())
    first = fit(holder, label="sandbox:warnings")
    holder.ended(first)
    again = holder.client.post(f"{first}/retry").headers["Location"]
    assert inputs_of(sandbox, first).keys() - inputs_of(sandbox, again).keys() == {SANDBOX}
    assert holder.job(again)["label"] == "sandbox:warnings"


def test_elsewhere_such_a_label_is_one_as_any(service: Service):
    assert service.client.get("/").json()["sandbox"] is False
    answer = service.post(request=REQUEST | {"label": "sandbox:nonsense"})
    assert answer.status_code == 202
    assert service.ended(answer.headers["Location"])["state"] == "succeeded"
    service.client.delete(answer.headers["Location"]).raise_for_status()
