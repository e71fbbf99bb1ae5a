"""Of which fits a derivation may have copies."""

from types import SimpleNamespace
from typing import Any, cast
from uuid import UUID

import pytest

from api_schemas.derivation_kinds.combined import CombinedOptions
from api_schemas.jobs import JobState
from api_schemas.results import Artifact
from service.api.derivations import derivation_inputs
from service.engine.port import FIT, JobExpiredError, StoredBlob, TenantJobs
from service.jobs.inputs import IMAGE, PERSON
from service.submissions.refusal import RefusedError

OWN = UUID("7c9e6679-7425-40de-944b-e07fc1f90ae7")
EXPIRED = UUID("0d3c1b6e-52a4-4f0e-9e37-0a4f6c2f7d10")
BLOB = StoredBlob(digest="0" * 64, media_type="image/png")


class Jobs:
    """Of two fits that succeeded, the time of one is over."""

    def job(self, job_id: str) -> Any:
        if job_id == str(EXPIRED):
            raise JobExpiredError(1.0)
        person = Artifact(name=PERSON, media_type="application/zip", size=1, sha256="0" * 64)
        return SimpleNamespace(
            id=job_id,
            root=FIT,
            state=JobState.SUCCEEDED,
            options=BLOB,
            inputs={IMAGE: BLOB},
            artifacts=(person,),
        )


def test_another_fit_that_has_expired_is_a_fault_of_the_request():
    jobs = Jobs()
    with pytest.raises(RefusedError) as caught:
        derivation_inputs(
            cast("TenantJobs", jobs),
            jobs.job(str(OWN)),
            CombinedOptions(kind="combined", fits=(EXPIRED,)),
            {},
        )
    (error,) = caught.value.problem.errors
    assert (caught.value.problem.status, error.field, error.code) == (
        422,
        "fits.0",
        "fits-unusable",
    )
    assert error.reason == f"The fit {EXPIRED} has expired."
