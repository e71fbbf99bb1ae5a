"""The kinds of derivations: their types, and what each is made of.

How a kind is made is in the module of :mod:`service.worker.derived` that has its name, which no
other process loads.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Generic, TypeVar

from api_schemas.derivation_kinds import AnyDerivationOptions, DerivationKind
from api_schemas.derivation_kinds.animation import AnimationOptions, AnimationResult
from api_schemas.derivation_kinds.base import BodyColours, DerivedFiles
from api_schemas.derivation_kinds.body_composition import (
    BodyCompositionOptions,
    BodyCompositionResult,
)
from api_schemas.derivation_kinds.caricature import CaricatureOptions, CaricatureResult
from api_schemas.derivation_kinds.pose import PoseOptions, PoseResult
from api_schemas.derivation_kinds.size import SizeOptions, SizeResult
from api_schemas.derivation_kinds.texture import TextureColours, TextureOptions, TextureResult
from service.api.derivation_parts import ATLAS, BVH, TABLE, FormPart
from service.jobs.inputs import (
    IMAGE,
    PERSON,
    RESULT,
    SEGMENTATION,
    of_view,
)

Options = TypeVar("Options", bound=AnyDerivationOptions)
Result = TypeVar("Result", bound=DerivedFiles)


@dataclass(frozen=True, slots=True, kw_only=True)
class Needs:
    """What a derivation is made of beside its request.

    Of the fit's inputs and files it has copies of those in ``of_fit``, so far as the fit has them.
    ``part`` may come along. Where it must, ``part_is_for`` goes on from "is missing, which".
    """

    of_fit: tuple[str, ...]
    part: FormPart | None = None
    part_is_for: str | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class DerivationKindDefinition(Generic[Options, Result]):
    """A kind of derivation.

    ``part`` is what comes along with some of its requests. What needs a picture of a scan and names
    none in particular gets its first (:data:`service.jobs.inputs.OF_FIRST_VIEW`).
    """

    kind: DerivationKind
    options: type[Options]
    result: type[Result]
    needs: Callable[[Options], Needs]
    part: FormPart | None = None


def _of_person(_: AnyDerivationOptions) -> Needs:
    return Needs(of_fit=(PERSON,))


def _of_measurements(_: AnyDerivationOptions) -> Needs:
    return Needs(of_fit=(PERSON, RESULT))


def _of_coloured_body(colours: BodyColours) -> tuple[str, ...]:
    return (
        (PERSON,)
        if colours is BodyColours.PLAIN
        else (PERSON, of_view(0, IMAGE), of_view(0, SEGMENTATION))
    )


def _of_pose(options: PoseOptions) -> Needs:
    return Needs(of_fit=_of_coloured_body(options.colours))


def _of_motion(options: AnimationOptions) -> Needs:
    is_needed = options.joints or options.up
    return Needs(
        of_fit=_of_coloured_body(options.colours),
        part=BVH,
        part_is_for="`joints` and `up` are about" if is_needed else None,
    )


def _of_texture(options: TextureOptions) -> Needs:
    if options.colours is not TextureColours.OWN:
        return Needs(of_fit=(PERSON, of_view(0, IMAGE), of_view(0, SEGMENTATION)))
    # Who brings the colours needs none of the picture's.
    return Needs(of_fit=(PERSON,), part=ATLAS, part_is_for="these colours are read from")


def _of_size(options: SizeOptions) -> Needs:
    of_fit = (PERSON, RESULT)
    if options.chart is not None or options.chart_csv is not None:
        return Needs(of_fit=of_fit)
    return Needs(
        of_fit=of_fit, part=TABLE, part_is_for="holds the sizes, as does the field 'chart'"
    )


_KINDS: Final[tuple[DerivationKindDefinition[Any, Any], ...]] = (
    DerivationKindDefinition(
        kind=DerivationKind.CARICATURE,
        options=CaricatureOptions,
        result=CaricatureResult,
        needs=_of_person,
    ),
    DerivationKindDefinition(
        kind=DerivationKind.POSE,
        options=PoseOptions,
        result=PoseResult,
        needs=_of_pose,
    ),
    DerivationKindDefinition(
        kind=DerivationKind.ANIMATION,
        options=AnimationOptions,
        result=AnimationResult,
        needs=_of_motion,
        part=BVH,
    ),
    DerivationKindDefinition(
        kind=DerivationKind.TEXTURE,
        options=TextureOptions,
        result=TextureResult,
        needs=_of_texture,
        part=ATLAS,
    ),
    DerivationKindDefinition(
        kind=DerivationKind.SIZE,
        options=SizeOptions,
        result=SizeResult,
        needs=_of_size,
        part=TABLE,
    ),
    DerivationKindDefinition(
        kind=DerivationKind.BODY_COMPOSITION,
        options=BodyCompositionOptions,
        result=BodyCompositionResult,
        needs=_of_measurements,
    ),
)

KINDS: Final[Mapping[str, DerivationKindDefinition[Any, Any]]] = {
    each.kind: each for each in _KINDS
}

FORM_PARTS: Final[Mapping[str, FormPart]] = {
    each.part.name: each.part for each in KINDS.values() if each.part is not None
}
"""All that may come along with a request, by name."""


def needs_of(options: AnyDerivationOptions) -> Needs:
    """What the derivation that is asked for is made of."""
    return KINDS[options.kind].needs(options)
