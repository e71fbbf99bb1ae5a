"""What pictures say of measurements that were given, had they not been given."""

from dataclasses import dataclass, replace

import numpy as np

from fitter.energies.attributes import NOTHING_KNOWN
from fitter.energies.joint_objective import JointCandidate, JointObjective
from fitter.optimizer.free_space import free_space
from fitter.optimizer.joint_equations import joint_equations
from fitter.population.known_person import KnownPerson
from fitter.vocabulary.measurements import STATURE


@dataclass(frozen=True, slots=True, kw_only=True)
class Foretold:
    """A measurement that was given, and what pictures and population say of it without that.

    In its unit.
    """

    name: str
    given: float
    value: float
    standard_error: float


def foretold(
    objective: JointObjective, candidate: JointCandidate, known: KnownPerson
) -> tuple[Foretold, ...]:
    """One Newton step from the minimum with all that was given, without it; the height stays.

    Measurements are so nearly linear in the shape that one step says enough.
    """
    told = objective.attributes
    given = [name for name in known.given if name != STATURE]
    names = [name for name in given if name in known.held]
    names += [name for name in given if name not in known.held]
    if not names:
        return ()
    shape = candidate.shape
    without = replace(objective, attributes=NOTHING_KNOWN)
    equations = joint_equations(without, candidate, free_space(NOTHING_KNOWN.held, shape))
    both = (told.held, told.uncertain)
    slopes = np.concatenate([each.jacobian(shape) for each in both]) @ equations.directions
    values = np.concatenate([each.measure(shape) for each in both])
    values = values + slopes @ equations.step(0.0).shape
    information = equations.shape_information()
    errors = np.sqrt((slopes * np.linalg.solve(information, slopes.T).T).sum(axis=1))
    return tuple(
        Foretold(name=name, given=float(value), value=float(found), standard_error=float(error))
        for name, value, found, error in zip(
            names,
            np.concatenate([each.values for each in both]),
            values,
            errors,
            strict=True,
        )
    )
