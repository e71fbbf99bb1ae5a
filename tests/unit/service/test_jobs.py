from api_schemas.jobs import JobState
from service.jobs.states import ACTIVE, TERMINAL, TRANSITIONS, may_become


def test_every_state_is_either_active_or_terminal():
    assert set(JobState) == ACTIVE | TERMINAL
    assert not ACTIVE & TERMINAL


def test_a_terminal_state_is_never_left():
    assert all(not TRANSITIONS[state] for state in TERMINAL)


def test_every_terminal_state_can_be_reached_from_running():
    assert TRANSITIONS[JobState.RUNNING] >= TERMINAL


def test_nothing_succeeds_or_times_out_without_running():
    assert may_become(JobState.SUCCEEDED) == {JobState.RUNNING}
    assert may_become(JobState.TIMED_OUT) == {JobState.RUNNING}


def test_a_job_whose_worker_stops_goes_back_to_the_queue():
    assert may_become(JobState.QUEUED) == {JobState.RUNNING}
