"""What a sandbox does before its first job: everything once."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from api_schemas.derivations import DerivationRequest
from service.worker import sandbox
from service.worker.pipeline_port import DerivationInput
from service.worker.sandbox_results import MAX_PIXELS, NOBODY, canned_results

_AT_ONCE: Final[tuple[Mapping[str, Any], ...]] = (
    {"kind": "pose", "pose": "standing"},
    {"kind": "figure"},
    {"kind": "body_composition"},
    {"kind": "change", "since": str(NOBODY)},
    {
        "kind": "size",
        "chart": {
            "sizes": [{"label": "M", "measurements": {"chest_girth": {"low": 90.0, "high": 100.0}}}]
        },
    },
)
"""One of each kind that is made anew for every job; what it loads is then there for all."""


def derive_all(models: Path | None, detector: Path | None) -> None:
    """Make the canned results, and once what is derived from them at once.

    Raises as :func:`service.worker.sandbox_results.canned_results` does.
    """
    first, *_ = canned_results(models, detector).fits.values()
    inputs = first.derivation_inputs
    for each in _AT_ONCE:
        sandbox.derive(
            DerivationInput(
                options=DerivationRequest.model_validate_json(json.dumps(each)).root,
                inputs=inputs,
                others=(inputs,),
                max_pixels=MAX_PIXELS,
                models=models,
                detector=detector,
            ),
            lambda _: None,
        )
