"""The space of bodies a subject is searched in: parameters and traits to source vertices.

A subject at rest is the base mesh plus targets, linear in their coefficients. *Parameters* are what
measurements decide: macro parameters from 0 to 1, or somewhat more, and local changes from -1 to 1.
*Traits* are what they do not: age, ancestry, face; they are drawn, and held while the parameters
are solved for.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from fitter.training.makehuman.meshes import BaseMesh, load_targets
from fitter.training.makehuman.phenotypes import (
    FACE_CHANGES,
    UPPER_BOUNDS,
    YOUNG_AGE,
    LocalChange,
    MacroTargets,
    free_axes,
    local_changes,
    macro_coefficients,
    macro_targets,
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Traits:
    """Traits that no measurement decides.

    Attributes
    ----------
    age
        On MakeHuman's axis: 2/3 a young adult, 1 a very old person.
    ancestry
        (3,) shares of the African, Asian and Caucasian targets, summing to one.
    face
        (c,) one value a change of :data:`FACE_CHANGES`, in [-1, 1].
    """

    age: float
    ancestry: Float[np.ndarray, "3"]
    face: Float[np.ndarray, " c"]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodySpace:
    """The searchable bodies of one gender.

    ``targets`` are (k, v, 3) displacements in metres: the macro targets, then for every local and
    every face change the target of its positive and of its negative side.
    """

    gender: str
    base: BaseMesh
    macro: MacroTargets
    changes: tuple[LocalChange, ...]
    targets: Float[np.ndarray, "k v 3"]
    parameter_names: tuple[str, ...]

    @property
    def lower(self) -> Float[np.ndarray, " q"]:
        """Lower bounds of the parameters."""
        return np.where(self._is_macro, 0.0, -1.0)

    @property
    def upper(self) -> Float[np.ndarray, " q"]:
        """Upper bounds of the parameters."""
        return np.array([UPPER_BOUNDS.get(name, 1.0) for name in self.parameter_names])

    @property
    def neutral(self) -> Float[np.ndarray, " q"]:
        """The average of MakeHuman: macro parameters half way, local changes none."""
        return np.where(self._is_macro, 0.5, 0.0)

    @property
    def _is_macro(self) -> np.ndarray:
        return np.arange(len(self.parameter_names)) < len(free_axes(self.gender))


def load_body_space(folder: Path, base: BaseMesh, gender: str) -> BodySpace:
    """Read all targets of one gender: about 2 s and 90 MB."""
    macro = macro_targets(gender)
    changes = local_changes(gender)
    count = len(base.source_vertices)
    sides = [
        load_targets(folder, names, count).sum(axis=0)
        for change in (*changes, *FACE_CHANGES)
        for names in (change.positive, change.negative)
    ]
    return BodySpace(
        gender=gender,
        base=base,
        macro=macro,
        changes=changes,
        targets=np.concatenate([load_targets(folder, macro.names, count), np.stack(sides)]),
        parameter_names=(*free_axes(gender), *(change.name for change in changes)),
    )


def average_traits() -> Traits:
    """A young adult of equal ancestries with an unchanged face."""
    return Traits(age=YOUNG_AGE, ancestry=np.full(3, 1.0 / 3.0), face=np.zeros(len(FACE_CHANGES)))


def target_coefficients(
    space: BodySpace, traits: Traits, parameters: Float[np.ndarray, " q"]
) -> tuple[Float[np.ndarray, " k"], Float[np.ndarray, "k q"]]:
    """Coefficients of all targets and their derivative by the parameters."""
    axes = free_axes(space.gender)
    values = dict(zip(axes, parameters[: len(axes)].tolist(), strict=True))
    macro, macro_derivative = macro_coefficients(
        space.macro, age=traits.age, ancestry=traits.ancestry, values=values
    )
    local = parameters[len(axes) :]
    coefficients = np.concatenate([macro, _two_sided(local), _two_sided(traits.face)])
    derivative = np.zeros((len(coefficients), len(parameters)))
    derivative[: len(macro), : len(axes)] = macro_derivative
    change = np.arange(len(local))
    positive = len(macro) + 2 * change
    derivative[positive, len(axes) + change] = local >= 0.0
    derivative[positive + 1, len(axes) + change] = -1.0 * (local < 0.0)
    return coefficients, derivative


def source_vertices(
    space: BodySpace, traits: Traits, parameters: Float[np.ndarray, " q"]
) -> Vertices:
    """All source vertices of a subject at rest, body frame, metres."""
    coefficients, _ = target_coefficients(space, traits, parameters)
    active = np.flatnonzero(coefficients)
    moved = space.base.source_vertices.copy()
    for target in active:
        moved += coefficients[target] * space.targets[target]
    return moved


def _two_sided(values: Float[np.ndarray, " c"]) -> Float[np.ndarray, " two_c"]:
    return np.stack([np.maximum(values, 0.0), np.maximum(-values, 0.0)], axis=1).ravel()
