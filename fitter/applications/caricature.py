"""Caricature (section 6): what is unusual of a body, exaggerated.

The paper multiplies the shape coefficient that deviates most from the mean by a factor. Often that
one is hardly seen: of eight people fitted to pictures, three changed by 4 to 7 mm (a factor of 2,
mean over the skin). Looks are all coefficients together: the same people changed by 1.1 to 3.5 cm.

The basis preserves height (section 4), so a caricature is as tall as its original: the height
coefficient is not exaggerated, and the micrometres by which the other axes change height are taken
back.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool

from fitter.arrays import Shape, Vertices
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape, shape_with_height
from fitter.errors import InvalidInputError
from fitter.numerics.mesh_faults import pierced_triangles
from fitter.numerics.meshes import mesh_topology, triangle_areas
from fitter.numerics.rotations import cross_products
from fitter.parameters import BodyParameters

MOST_TURNED_OVER = 0.0025
"""Share of the surface that may face the other way than on the fitted body. Thin bodies end here:
at -4 standard deviations of weight about 45 cm² of the packaged models have turned over between the
ribs, at -5 about 400, and arms and waist look like wrung cloth."""

MOST_CROSSING = 0.02
"""Share of the surface that may run through itself beyond what the fitted body's does (2 to 15
cm², the lips above all). Heavy bodies end here: thighs and folds of the belly run through each
other by 90 to 150 cm² at +3 standard deviations of weight, which people have, and 460 to 530 at
+5."""

MOST_DEVIATIONS = 10.0
"""Beyond so many standard deviations no coefficient is taken, though some axes would stay sound."""

_STEP = 1.0
_TOLERANCE = 0.05
# In standard deviations of the coefficient that deviates most.


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Caricature:
    """An exaggerated shape.

    Attributes
    ----------
    coefficient
        The coefficient of the shape that deviates most; never 0, the height's.
    before, after
        Its value, standard deviations.
    factor
        By which it was multiplied.
    shape
        (n,) the caricature's.
    height_m
        Of the fitted body and of the caricature.
    """

    coefficient: int
    before: float
    after: float
    factor: float
    shape: Shape
    height_m: float


def caricature_of_most_unusual(
    evaluator: ScapeEvaluator, shape: Shape, factor: float
) -> Caricature:
    """Multiply the most unusual coefficient of a shape, as the paper does.

    Parameters
    ----------
    evaluator
        Of the body model.
    shape
        (n,) the fitted person's.
    factor
        0 gives the mean in this respect, 1 the person, more an exaggeration.

    Raises
    ------
    InvalidInputError
        If the factor is negative or not finite, or so large that the mesh is no longer sound; the
        message names the largest that can be used.
    """
    multiplied = np.zeros(len(shape), dtype=bool)
    multiplied[most_unusual(shape)] = True
    return _multiplied(evaluator, shape, factor, multiplied)


def caricature_of_looks(evaluator: ScapeEvaluator, shape: Shape, factor: float) -> Caricature:
    """Multiply how a body differs from the average one of its height, in every respect.

    Parameters
    ----------
    evaluator, shape, factor
        As of :func:`caricature_of_most_unusual`.

    Raises
    ------
    InvalidInputError
        As there.
    """
    multiplied = np.ones(len(shape), dtype=bool)
    multiplied[0] = False
    return _multiplied(evaluator, shape, factor, multiplied)


def _multiplied(
    evaluator: ScapeEvaluator, shape: Shape, factor: float, multiplied: Bool[np.ndarray, " n"]
) -> Caricature:
    coefficient = most_unusual(shape)
    before = float(shape[coefficient])
    if not np.isfinite(factor) or factor < 0.0:
        raise _refused(
            reason=f"The factor is {factor}, no finite number from 0.",
            remedy="Send 1 for the body as it is, 2 for twice its deviation from the mean.",
        )
    if before == 0.0 and factor != 1.0:
        raise _refused(
            reason="The body is the mean body: nothing of it is unusual.",
            remedy="Fit a picture of a person.",
        )
    height_m = height_of_shape(evaluator, shape)
    exaggeration = _Exaggeration(evaluator, shape, multiplied, height_m)
    if not exaggeration.sound(factor):
        largest = float(np.floor(100.0 * exaggeration.farthest_sound()) / 100.0)
        raise _refused(
            reason=(
                f"Multiplied by {factor:g}, what is unusual of this body (coefficient "
                f"{coefficient} of its shape is {before:.2f} standard deviations) makes a surface "
                "that turns inside out or runs through itself."
            ),
            remedy=f"Send a factor from 0 to {largest:.2f}.",
            largest=largest,
        )
    return Caricature(
        coefficient=coefficient,
        before=before,
        after=factor * before,
        factor=factor,
        shape=exaggeration.shape(factor),
        height_m=height_m,
    )


def most_unusual(shape: Shape) -> int:
    """The coefficient that deviates most from the mean, of all but the height's."""
    return 1 + int(np.argmax(np.abs(shape[1:])))


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Soundness:
    """Shares of a body's surface that no surface of a body has.

    ``turned_over`` faces the other way than the reference's, ``crossing`` runs through another
    part of it.
    """

    turned_over: float
    crossing: float


class _Exaggeration:
    """Some coefficients of a person, to be multiplied."""

    def __init__(
        self,
        evaluator: ScapeEvaluator,
        shape: Shape,
        multiplied: Bool[np.ndarray, " n"],
        height_m: float,
    ) -> None:
        self._evaluator = evaluator
        self._shape = shape
        self._multiplied = multiplied
        self._height_m = height_m
        model = evaluator.model
        self._edges = mesh_topology(model.triangles, vertex_count=len(model.mean_vertices)).edges
        self._own = self._canonical(shape)
        self._own_crossing = self._soundness(self._own).crossing

    def shape(self, factor: float) -> Shape:
        """The person with these coefficients times a factor, as tall as before."""
        changed = np.where(self._multiplied, factor * self._shape, self._shape)
        return shape_with_height(self._evaluator, changed, self._height_m)

    def sound(self, factor: float) -> bool:
        """Whether the surface stays one."""
        if factor <= 1.0:
            return True
        if factor * self._largest > MOST_DEVIATIONS:
            return False
        found = self._soundness(self._canonical(self.shape(factor)))
        return (
            found.turned_over <= MOST_TURNED_OVER
            and found.crossing <= self._own_crossing + MOST_CROSSING
        )

    def farthest_sound(self) -> float:
        """The largest factor before which all are sound."""
        step, tolerance = _STEP / self._largest, _TOLERANCE / self._largest
        inner, outer = 1.0, 1.0 + step
        while outer * self._largest <= MOST_DEVIATIONS and self.sound(outer):
            inner, outer = outer, outer + step
        while outer - inner > tolerance:
            middle = 0.5 * (inner + outer)
            if self.sound(middle):
                inner = middle
            else:
                outer = middle
        return inner

    @property
    def _largest(self) -> float:
        return float(np.abs(self._shape[self._multiplied]).max())

    def _canonical(self, shape: Shape) -> Vertices:
        return self._evaluator.body_frame_vertices(
            BodyParameters(
                pose=self._evaluator.model.canonical_pose, translation=np.zeros(3), shape=shape
            )
        )

    def _soundness(self, vertices: Vertices) -> Soundness:
        triangles = self._evaluator.model.triangles
        areas = triangle_areas(vertices, triangles)
        facing = np.einsum(
            "fi,fi->f", _area_vectors(vertices, triangles), _area_vectors(self._own, triangles)
        )
        crossing = pierced_triangles(vertices, triangles, self._edges)
        surface = float(areas.sum())
        return Soundness(
            turned_over=float(areas[facing <= 0.0].sum()) / surface,
            crossing=float(areas[crossing].sum()) / surface,
        )


def _area_vectors(vertices: Vertices, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return cross_products(b - a, c - a)


def _refused(*, reason: str, remedy: str, largest: float | None = None) -> InvalidInputError:
    return InvalidInputError(
        code="factor-unusable", field="factor", reason=reason, remedy=remedy, largest=largest
    )
