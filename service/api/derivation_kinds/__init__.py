"""The kinds of derivations: one module a kind declares all there is to know of it.

How a kind is made is in the module of :mod:`service.worker.derived` that has its name, which no
other process loads.
"""

from collections.abc import Mapping
from typing import Any, Final

from api_schemas.derivation_kinds import AnyDerivationOptions
from service.api.derivation_kinds import (
    animation,
    body_composition,
    caricature,
    change,
    combined,
    figure,
    pose,
    report,
    size,
    texture,
)
from service.api.derivation_kinds.definition import DerivationKindDefinition, FormPart, Needs

KINDS: Final[Mapping[str, DerivationKindDefinition[Any, Any]]] = {
    each.KIND.kind: each.KIND
    for each in (
        *(report, caricature, pose, animation, figure, texture, combined),
        *(size, body_composition, change),
    )
}

FORM_PARTS: Final[Mapping[str, FormPart]] = {
    each.part.name: each.part for each in KINDS.values() if each.part is not None
}
"""All that may come along with a request, by name."""


def needs_of(options: AnyDerivationOptions) -> Needs:
    """What the derivation that is asked for is made of."""
    return KINDS[options.kind].needs(options)
