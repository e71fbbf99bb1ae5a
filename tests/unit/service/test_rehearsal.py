"""What a fork server does before it forks: it reads kernels, or makes a fit."""

import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest

from fitter.errors import ModelFileError
from service.jobs.inputs import SentPicture
from service.numerics.fork_server import THREAD_LIMITS
from service.submissions.submission import check_fit
from service.worker import pipeline, rehearsal
from service.worker.pipeline_port import PipelineInput, PipelineOutput
from service.worker.rehearsal import rehearse
from tests.submissions import small_submissions

REPOSITORY = Path(__file__).parents[3]


def fitted() -> PipelineOutput:
    (submission,) = small_submissions(1)
    checked = check_fit(
        request=submission.request.encode(), image=submission.image, mask=None, max_pixels=10**6
    )
    return pipeline.run(
        PipelineInput(
            options=checked.options,
            pictures=(SentPicture(submission.image, None),),
            max_pixels=10**6,
            models=None,
        ),
        lambda _: None,
    )


def told(program: str) -> str:
    """What a process of its own prints, which warns of nothing."""
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=REPOSITORY,
        env=os.environ | dict.fromkeys(THREAD_LIMITS, "1"),
        capture_output=True,
        text=True,
        check=True,
    )
    assert "could not be fitted" not in done.stderr
    return done.stdout


def test_later_fits_are_what_they_would_have_been_without_it():
    before = fitted()
    rehearse(None)
    after = fitted()
    assert dict(after.artifacts) == dict(before.artifacts)
    unclocked = {"stage_seconds": {}}
    assert after.result.model_copy(update=unclocked) == before.result.model_copy(update=unclocked)


@pytest.mark.slow
def test_the_fork_server_has_no_threads_that_a_fork_would_lose():
    counted = (
        "import os\nimport service.worker.preload\nprint(len(os.listdir('/proc/self/task')))\n"
    )
    assert int(told(counted)) == 1


def test_a_sample_that_cannot_be_fitted_is_told_and_no_more(monkeypatch, caplog):
    sample = rehearsal.load_sample()
    request = json.dumps(json.loads(sample.request) | {"height_m": 2.3, "weight_kg": 30.0})
    monkeypatch.setattr(rehearsal, "load_sample", lambda: replace(sample, request=request.encode()))
    rehearse(None)
    assert "could not be fitted" in caplog.text


def test_a_missing_model_is_an_error_of_its_own(tmp_path):
    with pytest.raises(ModelFileError):
        rehearse(tmp_path)


@pytest.mark.slow
def test_a_fit_after_the_kernels_were_read_compiles_no_other(tmp_path):
    program = """
from service.process.caches import settle_folders
settle_folders()
from numba.core import event
from fitter.fits.prepared_model import prepared_model
from fitter.request import Gender
from service.worker.rehearsal import make_ready, rehearse
for gender in Gender:
    prepared_model(gender)
make_ready(None)
with event.install_recorder("numba:compile") as compiled:
    rehearse(None)
print(len(compiled.buffer))
"""
    assert int(told(program)) == 0
