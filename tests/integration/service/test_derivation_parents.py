"""From which fits a tenant may derive, as the engine decides it."""

from typing import Any

from service.engine.port import NewJob, StoredBlob, SubmitOutcome
from tests.integration.service.harness import Machine
from tests.integration.service.test_images import engine_of


def new_job(name: str, kind: str) -> NewJob:
    blob = StoredBlob(digest="0" * 64, media_type="application/json")
    return NewJob(id=name, kind=kind, options=blob, inputs={"image": blob})


def test_a_tenant_derives_from_its_own_fits_alone_and_from_none_that_is_gone(machine: Machine):
    engine = engine_of(machine)
    try:
        ours, theirs = engine.of("ours"), engine.of("theirs")
        ours.reserve("fit", None)
        assert ours.submit(new_job("fit", "fit")).outcome is SubmitOutcome.ACCEPTED

        def submit(jobs: Any, name: str) -> SubmitOutcome:
            jobs.reserve(name, None)
            return jobs.submit(new_job(name, "pose")).outcome

        # It has not ended: there is nothing yet to derive from.
        assert submit(ours.derivations("fit"), "early") is SubmitOutcome.PARENT_GONE
        ours.cancel("fit")
        assert submit(theirs.derivations("fit"), "stolen") is SubmitOutcome.PARENT_GONE
        assert submit(ours.derivations("fit"), "one") is SubmitOutcome.ACCEPTED
        record = ours.derivations("fit").job("one")
        assert record is not None
        assert (record.kind, record.parent) == ("pose", "fit")
        assert record.inputs == new_job("one", "pose").inputs
        assert ours.job("one") is None
        assert theirs.derivations("fit").job("one") is None
        assert theirs.derivations("fit").jobs(limit=9, before=None, state=None) == []
        assert list(theirs.derivations("fit").erase("one")) == []
        assert sorted(ours.erase("fit")) == ["fit", "one"]
        assert ours.derivations("fit").job("one") is None
        assert submit(ours.derivations("fit"), "late") is SubmitOutcome.PARENT_GONE
    finally:
        engine.close()
