"""The energy of one person in one or several pictures, as a function of a body in each.

With one shape β, a pose and place θ_k in picture k, and E_k what that picture says (E1 or E2 with
the priors on pose and stance, :mod:`fitter.energies.objective`),

    E(β, θ_1 ... θ_K) = w Σ_k E_k(β, θ_k) + prior(β) + known(β).

What is known of the shape counts once, however many pictures there are. Held attributes have no
term: a search stays among the bodies that have them. The weight w is one for one picture, and less
where several share part of their errors.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fitter.arrays import Shape
from fitter.energies.attributes import KnownAttributes, ShapeEquations
from fitter.energies.objective import Body, Candidate, Objective
from fitter.energies.priors import ShapePrior
from fitter.energies.terms import ShapeTerm, shape_terms_of
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointCandidate:
    """One shape, posed in each picture, with its energies.

    ``energies`` are those of the whole: each picture's terms, weighted and summed by name, and
    those of the shape.
    """

    views: tuple[Candidate, ...]
    energies: Mapping[str, float]

    @property
    def total(self) -> float:
        """The sum of all terms, nats."""
        return sum(self.energies.values())

    @property
    def shape(self) -> Shape:
        """(n,) that all bodies have."""
        return self.views[0].parameters.shape

    @property
    def bodies(self) -> tuple[BodyParameters, ...]:
        """The body in each picture."""
        return tuple(view.parameters for view in self.views)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointObjective:
    """See the module.

    Attributes
    ----------
    views
        What each picture says.
    weight
        w.
    shape_prior, attributes
        What is known of the shape; held attributes have no term.
    """

    views: tuple[Objective, ...]
    weight: float
    shape_prior: ShapePrior
    attributes: KnownAttributes

    @property
    def shape_terms(self) -> tuple[ShapeTerm, ...]:
        """Energies of what is known of the shape."""
        return shape_terms_of(self.shape_prior, self.attributes)

    def shape_equations(self, shape: Shape) -> ShapeEquations:
        """Matrix and gradient of what is known of the shape."""
        n = len(shape)
        matrix, gradient = np.zeros((n, n)), np.zeros(n)
        for term in self.shape_terms:
            own, slope = term.equations(shape)
            matrix, gradient = matrix + own, gradient + slope
        return matrix, gradient

    def evaluate(self, bodies: Sequence[Body]) -> JointCandidate:
        """The true energy of bodies of one shape.

        Raises
        ------
        NumericalError
            If a term is not finite.
        """
        found = [view.evaluate(body) for view, body in zip(self.views, bodies, strict=True)]
        shape = found[0].parameters.shape
        energies: dict[str, float] = {}
        for each in found:
            for name, energy in each.energies.items():
                energies[name] = energies.get(name, 0.0) + self.weight * energy
        energies |= {term.name: term.energy(shape) for term in self.shape_terms}
        return JointCandidate(views=tuple(found), energies=energies)

    def with_views(self, views: Sequence[Objective]) -> "JointObjective":
        """The same with other evidence."""
        return replace(self, views=tuple(views))
