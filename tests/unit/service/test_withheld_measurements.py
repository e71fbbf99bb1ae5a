"""What needs measurements says so where they are withheld."""

import json
from uuid import UUID

import pytest
from rich.console import Console

from api_schemas.derivation_kinds.combined import CombinedOptions
from fitter.errors import InvalidInputError
from service.commands.terminal import print_result
from service.jobs.inputs import RESULT
from service.worker.derived.combined import derive
from service.worker.pipeline_port import DerivationInput
from tests.unit.service.fit_results import RESULT as EXAMPLE
from tests.unit.service.fit_results import fit_result

WITHHELD = {"measurements": [], "outcome": "poor_fit", "verdict": "implausible"}
EXPLAINED = "Two people."


def document(**changes: object) -> bytes:
    return json.dumps(EXAMPLE | {"outcome_explanation": EXPLAINED} | changes).encode()


@pytest.mark.parametrize(("withheld", "field"), [(0, "kind"), (1, "fits.0"), (2, "fits.1")])
def test_a_fit_without_measurements_is_not_combined(withheld, field):
    documents = [document(**(WITHHELD if number == withheld else {})) for number in range(3)]
    own, *others = [{RESULT: each} for each in documents]
    options = CombinedOptions(kind="combined", fits=(UUID(int=1), UUID(int=2)))
    job = DerivationInput(options=options, inputs=own, others=tuple(others), max_pixels=1)
    with pytest.raises(InvalidInputError) as refused:
        derive(job, lambda _: None)
    assert (refused.value.code, refused.value.field) == ("fits-unusable", field)
    assert EXPLAINED in refused.value.reason


def test_the_command_line_says_how_to_have_them():
    console = Console(record=True, width=200)
    print_result(console, fit_result(**WITHHELD))
    told = console.export_text()
    assert "--force" in told
    assert "implausible" in told
    assert "Measurements, male" not in told
