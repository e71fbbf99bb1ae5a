"""One shape for several pictures in one search: to the joint minimum of E1, then to that of E2.

Searches follow those of a single picture (:mod:`fitter.fits.descents`, and section 5's alternation,
:mod:`fitter.optimizer.alternation`): outlines are found again before each, and light and
reflectance of every picture in turn with the bodies in all of them. They end earlier, and take
fewer rounds, for where several views tell the depth shading has less left to tell.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from fitter.arrays import Shape
from fitter.energies.joint_objective import JointObjective
from fitter.energies.objective import Body, Candidate, EnergyObserver, Objective
from fitter.energies.priors import population_prior
from fitter.fits.foretold import Foretold, foretold
from fitter.fits.joint_view import JointView
from fitter.fits.lit_view import LitView, first_lit
from fitter.fits.settling import compared_with, settle
from fitter.optimizer.gauss_newton import Minimum
from fitter.optimizer.joint_gauss_newton import JointMinimum, minimize_jointly
from fitter.optimizer.joint_uncertainty import joint_certainty
from fitter.optimizer.search import limits_of
from fitter.optimizer.uncertainty import shape_covariance
from fitter.person.several_pictures import counted_as
from fitter.population.known_person import KnownPerson
from fitter.request import OptimizerKind
from fitter.result import PictureFit

SHARED_ERROR = 0.2
"""Correlation of the errors of two pictures that are searched together. It is less than that of
whole fits of one picture (:data:`fitter.person.several_pictures.SHARED_ERROR`), because what
a prior about depth makes them err in alike, another view tells."""

ROUGHLY_SETTLED_NATS = 0.5
"""Gain below which a search ends that another follows."""

LAST_SETTLED_NATS = 0.1
"""The same of the last: twice that of one picture, for two are about twice as rough."""

ROUNDS = ((0, ROUGHLY_SETTLED_NATS), (2, LAST_SETTLED_NATS))
"""The first and the last round of the alternation, by their number in
:data:`fitter.optimizer.alternation.SMOOTHNESS_SCHEDULE`, and where the search of each ends."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class JointlyFound:
    """One person in several pictures.

    Attributes
    ----------
    shape, covariance
        (n,) coefficients and their (n, n) covariance.
    pictures
        The person in each picture, in the order given.
    foretold
        What all pictures say of the measurements that were given besides the height.
    """

    shape: Shape
    covariance: Float[np.ndarray, "n n"]
    pictures: tuple[PictureFit, ...]
    foretold: tuple[Foretold, ...]


def search_jointly(
    views: Sequence[JointView], known: KnownPerson, start: Shape, report: EnergyObserver
) -> JointlyFound:
    """From bodies near the person in each picture, and a shape, to the joint minimum.

    ``start`` has what is held. Pictures whose request has no shading take part with E1.
    """
    bodies: Sequence[Body] = [replace(view.body, shape=start) for view in views]
    objective = JointObjective(
        views=tuple(view.objective for view in views),
        weight=counted_as(len(views), shared=SHARED_ERROR) / len(views),
        shape_prior=population_prior(len(start)),
        attributes=known.attributes,
    )

    def minimum(energies: Sequence[Objective], most: int, settled_nats: float) -> JointMinimum:
        """Search against outlines that are found anew along the present bodies."""
        about = _about(views, energies, bodies)
        return minimize_jointly(
            objective.with_views(about),
            bodies,
            max_evaluations=most,
            on_energies=report,
            settled_nats=settled_nats,
        )

    limits = limits_of(OptimizerKind.GAUSS_NEWTON)
    found = minimum(
        [view.objective for view in views], limits.silhouette_and_edges, ROUGHLY_SETTLED_NATS
    )
    bodies = found.candidate.views
    lit = [first_lit(view, seen) for view, seen in zip(views, found.candidate.views, strict=True)]
    shows_light = any(each.shading is not None for each in lit)
    for number, settled_nats in ROUNDS if shows_light else ROUNDS[-1:]:
        seen = found.candidate.views
        lit = [each.next(body, number) for each, body in zip(lit, seen, strict=True)]
        most = limits.shading_round if shows_light else limits.silhouette_and_edges
        found = minimum([each.energy for each in lit], most, settled_nats)
        bodies = found.candidate.views
    return _settled(views, known, objective, lit, found)


def _about(
    views: Sequence[JointView], energies: Sequence[Objective], bodies: Sequence[Body]
) -> list[Objective]:
    return [
        view.searches.about(energy, body)
        for view, energy, body in zip(views, energies, bodies, strict=True)
    ]


def _settled(
    views: Sequence[JointView],
    known: KnownPerson,
    objective: JointObjective,
    lit: Sequence[LitView],
    found: JointMinimum,
) -> JointlyFound:
    """The person in every picture, with light and reflectance, and how certain the shape is."""
    shape_energy = found.candidate.energies["shape_prior"]
    seen: list[Candidate] = [
        replace(each, energies={**each.energies, "shape_prior": shape_energy})
        for each in found.candidate.views
    ]
    shaded = [
        each.settled(
            Minimum(candidate=body, converged=found.converged, evaluations=found.evaluations)
        )
        for each, body in zip(lit, seen, strict=True)
    ]
    compared = [
        each.with_shading(compared_with(view.searches, each))
        for view, each in zip(views, shaded, strict=True)
    ]
    certain = joint_certainty(objective.with_views(compared), seen)
    pictures = tuple(
        settle(
            view.request,
            view.observation,
            each.objective.operators.model,
            each,
            certainty,
            height_m=known.height_m,
            height_variance=known.height_variance,
        )
        for view, each, certainty in zip(views, shaded, certain, strict=True)
    )
    return JointlyFound(
        shape=found.candidate.shape,
        covariance=shape_covariance(certain[0], height_variance=known.height_variance),
        pictures=pictures,
        foretold=foretold(
            objective.with_views(compared), replace(found.candidate, views=tuple(seen)), known
        ),
    )
