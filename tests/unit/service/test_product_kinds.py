"""Every kind of product is complete: on the wire, and where it is made."""

import subprocess
import sys
from typing import Any, get_args, get_type_hints

import pytest

from api_schemas.products import AnyProductOptions, AnyProductResult, ProductRequest, product_id
from api_schemas.products.base import ProductKind
from service.compute.pipeline import maker_of
from service.compute.products.finished_fit import Made

OPTIONS: dict[str, Any] = {
    tag.tag.strip("[]"): model for model, tag in map(get_args, get_args(AnyProductOptions))
}
RESULTS: dict[str, Any] = {
    get_args(model.model_fields["kind"].annotation)[0]: model
    for model in get_args(get_args(AnyProductResult)[0])
}


def test_every_kind_has_options_and_a_result():
    assert list(OPTIONS) == list(RESULTS) == list(ProductKind)


@pytest.mark.parametrize("kind", ProductKind)
def test_what_makes_a_kind_takes_its_options_and_gives_its_result(kind: str):
    for model in (OPTIONS[kind], RESULTS[kind]):
        assert get_args(model.model_fields["kind"].annotation) == (kind,)
    hints = get_type_hints(maker_of(kind))
    assert hints["options"] == OPTIONS[kind]
    assert hints["return"] == Made[RESULTS[kind]]


def asked(text: str, part: bytes | None = None) -> str:
    return product_id(ProductRequest.model_validate_json(text).root, part)


def test_an_id_is_of_the_options_as_understood_and_of_the_part():
    plain = asked('{"kind": "caricature"}')
    assert plain == asked('{"factor": 2, "kind": "caricature"}')
    assert plain != asked('{"kind": "caricature", "factor": 2.5}')
    turned = [
        asked('{"kind": "pose", "rotations": {"head": [0, 0, 1], "left_hand": [0, 0, 1]}}'),
        asked('{"kind": "pose", "rotations": {"left_hand": [0, 0, 1], "head": [0, 0, 1]}}'),
    ]
    assert turned[0] == turned[1]
    sent = {asked('{"kind": "size"}', part) for part in (None, b"", b"a", b"b")}
    assert len(sent) == 4


def test_a_process_for_fits_has_loaded_nothing_that_makes_products():
    """Every process forked for a fit would carry more along."""
    code = (
        "import sys, service.compute.child, service.compute.pipeline;"
        "print([each for each in sys.modules if each.startswith('service.compute.products.')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert done.stdout.strip() == "['service.compute.products.finished_fit']"
