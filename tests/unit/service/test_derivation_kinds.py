"""Every kind of derivation is complete: on the wire, as it is declared, and where it is made."""

import json
import subprocess
import sys
from collections.abc import Callable
from typing import Any, get_args, get_type_hints

import pytest

from api_schemas.derivation_kinds import (
    AnyDerivationOptions,
    AnyDerivationResult,
    DerivationKind,
)
from api_schemas.derivations import DerivationRequest, DerivationResult
from service.api.derivation_kinds import KINDS, DerivationKindDefinition, needs_of
from service.api.openapi import recorded_examples
from service.jobs.inputs import PERSON
from service.worker.derivers import load_deriver
from service.worker.pipeline_port import DerivationInput, DerivationOutput

each_kind = pytest.mark.parametrize(
    "kind", [pytest.param(each, id=each.kind) for each in KINDS.values()]
)
Definition = DerivationKindDefinition[Any, Any]


def told_apart_by(union: object) -> dict[str, object]:
    """The types of a union by their tags without the brackets, in its order."""
    alternatives = (get_args(each) for each in get_args(union))
    return {tag.tag.strip("[]"): model for model, tag in alternatives}


def asked(kind: Definition) -> list[AnyDerivationOptions]:
    """The recorded requests for derivations of a kind."""
    recorded = recorded_examples()["requests"]["submit_fit_derivation"].values()
    parsed = [DerivationRequest.model_validate_json(json.dumps(each)).root for each in recorded]
    return [each for each in parsed if each.kind == kind.kind]


def test_every_kind_of_the_wire_is_declared():
    assert set(KINDS) == set(DerivationKind)


def test_the_wire_tells_the_declared_types_apart_by_their_kinds():
    by_kind = {kind: KINDS[kind] for kind in DerivationKind}
    for union, declared in (
        (AnyDerivationOptions, {kind: each.options for kind, each in by_kind.items()}),
        (AnyDerivationResult, {kind: each.result for kind, each in by_kind.items()}),
    ):
        assert list(told_apart_by(union).items()) == list(declared.items())


@each_kind
def test_options_and_result_say_of_which_kind_they_are(kind: Definition):
    for model in (kind.options, kind.result):
        assert get_args(model.model_fields["kind"].annotation) == (kind.kind,)


@each_kind
def test_a_request_and_a_result_are_shown(kind: Definition):
    assert asked(kind)
    for options in asked(kind):
        assert type(options) is kind.options
    shown = recorded_examples()["answers"]["get_fit_derivation_result"]["200"][kind.kind]
    answer = DerivationResult.model_validate_json(json.dumps(shown)).root
    assert type(answer) is kind.result
    assert answer.files


@each_kind
def test_what_a_request_needs_is_of_the_person_and_no_other_part_than_the_declared_one(
    kind: Definition,
):
    for options in asked(kind):
        needs = needs_of(options)
        assert PERSON in needs.of_fit
        assert needs.part in (None, kind.part)


@each_kind
def test_what_derives_a_kind_takes_its_options_and_gives_its_result(kind: Definition):
    job, observe, derived = get_type_hints(load_deriver(kind.kind)).values()
    assert job == DerivationInput[kind.options]
    assert observe == Callable[[float], None]
    assert derived == DerivationOutput[kind.result]


def test_a_process_for_fits_has_loaded_nothing_that_derives():
    """Only the package itself: every process forked for a fit would carry more along."""
    code = (
        "import sys, service.numerics.child, service.worker.pipeline;"
        "print([each for each in sys.modules if each.startswith('service.worker.derived')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert done.stdout.strip() == "['service.worker.derived']"
