"""A sandbox's endings, the forms of its results, and that it keeps to databases of its own."""

from pathlib import Path
from uuid import uuid4

import pytest
import sqlalchemy as sa

from api_schemas.derivation_kinds.combined import CombinedPicture, CombinedResult
from api_schemas.problems import PROBLEM_TYPES
from service.api.sandbox import asked_ending
from service.engine.database import check_database, open_database, prepare_database
from service.engine.port import DatabaseUnusableError, Ending, Report
from service.engine.sandbox import SANDBOX_FACT
from service.engine.tables import FACTS, JOBS
from service.jobs.sandbox import (
    BY_ACCIDENT,
    ENDINGS,
    UNUSABLE_FOR_DERIVATIONS,
    UNUSABLE_PICTURES,
    VERDICTS,
    Whose,
    slowness_s,
)
from service.numerics.tasks import ProblemError
from service.submissions.refusal import RefusedError
from service.worker.endings import ending_by, input_gone, too_slow
from service.worker.pipeline_port import DerivationOutput, UnusableInputError
from service.worker.sandbox_endings import end_as_asked
from service.worker.sandbox_forms import combined_of_fits

REPORTS = (Report(stage="first", progress=0.1), Report(stage="last", progress=0.9))


def test_other_labels_ask_for_nothing():
    for label in (None, "customer-4711", "sandbox", "a sandbox:slow"):
        assert asked_ending(label, Whose.PICTURES) is None


@pytest.mark.parametrize("whose", Whose)
def test_every_ending_can_be_asked_for_by_those_it_is_meant_for_alone(whose: Whose):
    prefix = "sandbox:derivations:" if whose is Whose.DERIVATIONS else "sandbox:"
    (other,) = set(Whose) - {whose}
    for ending in ENDINGS[whose]:
        assert asked_ending(prefix + ending, whose) == ending
        assert asked_ending(prefix + ending, other) is None


@pytest.mark.parametrize("label", ["sandbox:", "sandbox:no", "sandbox:slow:", "sandbox:no-light"])
def test_unknown_endings_are_refused_with_all_there_are(label: str):
    with pytest.raises(RefusedError) as refused:
        asked_ending(label, Whose.DERIVATIONS)
    remedy = refused.value.problem.remedy
    assert all(f"sandbox:{ending}" in remedy for ending in ENDINGS[Whose.PICTURES])


def test_slowness_is_in_seconds_up_to_five_minutes():
    asked = ("slow", "slow:5", "slow:300", "slow:301", "slow:0", "slow:-1", "slower")
    assert [slowness_s(each) for each in asked] == [20, 5, 300, None, None, None, None]


def test_a_quick_job_reports_once():
    seen: list[Report] = []
    end_as_asked(None, REPORTS, seen.append)
    assert seen == [REPORTS[-1]]


@pytest.mark.parametrize("ending", [*UNUSABLE_PICTURES, *UNUSABLE_FOR_DERIVATIONS])
def test_what_cannot_be_used_is_told_with_its_code(ending: str):
    with pytest.raises(UnusableInputError) as raised:
        end_as_asked(ending, REPORTS, lambda _: None)
    assert raised.value.error.code == ending


@pytest.mark.parametrize(
    "ending",
    sorted({*BY_ACCIDENT} - {"fit-crashed", "fit-failed", "out-of-memory"}),
)
def test_accidents_have_the_code_that_was_asked_for(ending: str):
    with pytest.raises(ProblemError) as raised:
        end_as_asked(ending, REPORTS, lambda _: None)
    assert raised.value.problem.code == ending


@pytest.mark.parametrize("ending", ["warnings", *VERDICTS])
def test_what_is_only_judged_otherwise_succeeds(ending: str):
    end_as_asked(ending, REPORTS, lambda _: None)


def test_accidents_are_faults_of_the_service():
    for code in set(BY_ACCIDENT) & PROBLEM_TYPES.keys():
        assert PROBLEM_TYPES[code].status >= 500


def test_of_several_pictures_the_first_is_at_fault():
    for ending, field in (
        ("person-not-found", "views.0.image"),
        ("contradictory-measurements", "weight_kg"),
    ):
        with pytest.raises(UnusableInputError) as raised:
            end_as_asked(ending, REPORTS, lambda _: None, pictures=2)
        assert raised.value.error.field == field


def test_only_the_time_limit_times_out():
    assert ending_by(too_slow(1.0)) is Ending.TIMED_OUT
    assert ending_by(input_gone()) is Ending.FAILED


def test_a_combined_body_is_of_the_fits_that_were_sent():
    bodies = tuple(
        CombinedPicture.model_construct(number=number, fit_id=uuid4(), outcome=f"of {number}")
        for number in (1, 2)
    )
    kept = DerivationOutput(
        result=CombinedResult.model_construct(bodies=bodies, pictures=2, kind="combined"),
        artifacts={
            "body_combined.glb": b"whole",
            **{f"{name}_{n}.{end}": f"{name} {n}".encode() for n in (1, 2) for name, end in FILES},
        },
    )
    fits = [uuid4() for _ in range(3)]
    made = combined_of_fits(kept, fits)
    assert made.result.pictures == 3
    assert [each.fit_id for each in made.result.bodies] == fits
    assert [each.number for each in made.result.bodies] == [1, 2, 3]
    assert [each.outcome for each in made.result.bodies] == ["of 1", "of 2", "of 2"]
    assert made.artifacts["overlay_3.png"] == made.artifacts["overlay_2.png"] == b"overlay 2"
    assert made.artifacts["body_posed_1.glb"] == b"body_posed 1"


FILES = (("body_posed", "glb"), ("overlay", "png"))


@pytest.mark.parametrize("sandbox", [True, False])
def test_who_comes_first_decides_what_a_database_is(tmp_path: Path, sandbox: bool):
    url = f"sqlite:///{tmp_path}/maquette.sqlite"
    # Keys may be made before anybody serves.
    prepare_database(url)
    check_database(url, sandbox=sandbox)
    for _ in range(2):
        prepare_database(url, sandbox=sandbox)
    check_database(url, sandbox=sandbox)
    prepare_database(url)
    for open_it in (check_database, prepare_database):
        with pytest.raises(DatabaseUnusableError, match="MAQUETTE_SANDBOX=") as refused:
            open_it(url, sandbox=not sandbox)
        assert "\n" not in str(refused.value)


def test_jobs_of_earlier_versions_are_real(tmp_path: Path):
    url = f"sqlite:///{tmp_path}/maquette.sqlite"
    prepare_database(url, sandbox=False)
    database = open_database(url, connections=1)
    with database.begin() as connection:
        connection.execute(sa.delete(FACTS).where(FACTS.c.name == SANDBOX_FACT))
        needed = {
            column.name: 0 if isinstance(column.type, sa.Integer | sa.Double) else "x"
            for column in JOBS.columns
            if not column.nullable
        }
        connection.execute(sa.insert(JOBS).values(needed | {"cancel_requested": False}))
    database.dispose()
    with pytest.raises(DatabaseUnusableError, match="MAQUETTE_SANDBOX=true"):
        prepare_database(url, sandbox=True)
    prepare_database(url, sandbox=False)
