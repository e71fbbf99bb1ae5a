"""The examples of the OpenAPI document are what a service is asked and answers."""

import copy
import json
from pathlib import Path

from service.api.openapi import recorded_examples
from tests.contract.recorder import differences
from tests.contract.recording import recorded_from_service


def test_the_examples_are_what_a_service_answers(tmp_path: Path):
    recorded = recorded_from_service(tmp_path)
    assert differences(recorded, recorded_examples()) == [], "run `make examples openapi`"


def test_an_example_that_is_no_answer_would_be_noticed():
    shown = recorded_examples()
    other = copy.deepcopy(dict(shown))
    fit = other["answers"]["get_fit"]["200"]
    fit["succeeded"]["state"] = "failed"
    del fit["running"]["label"]
    other["answers"]["list_fits"]["200"]["first-page"]["fits"].clear()
    assert len(differences(json.loads(json.dumps(other)), shown)) == 3
