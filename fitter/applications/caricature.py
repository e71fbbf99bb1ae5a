"""Caricature (section 6): what is unusual of a body, exaggerated.

The shape coefficient that deviates most from the mean is multiplied by a factor. The basis
preserves height (section 4), so a caricature is as tall as its original: the height coefficient is
not exaggerated, and the micrometres by which the other axes change height are taken back.
"""

from dataclasses import dataclass

import numpy as np

from fitter.arrays import Shape, Vertices
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import height_of_shape, shape_with_height
from fitter.errors import InvalidInputError
from fitter.numerics.mesh_topology import mesh_topology
from fitter.numerics.meshes import triangle_areas
from fitter.numerics.self_crossing import pierced_triangles
from fitter.numerics.vectors import cross_products
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


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Caricature:
    """An exaggerated shape.

    Attributes
    ----------
    coefficient
        Which coefficient of the shape was multiplied; never 0, the height's.
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


def caricature(evaluator: ScapeEvaluator, shape: Shape, factor: float) -> Caricature:
    """Multiply the most unusual coefficient of a shape.

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
    exaggeration = _Exaggeration(evaluator, shape, coefficient, height_m)
    after = factor * before
    if not exaggeration.sound(after):
        largest = exaggeration.farthest_sound() / before
        raise _refused(
            reason=(
                f"Multiplied by {factor:g}, coefficient {coefficient} of this body's shape "
                f"({before:.2f} standard deviations) makes a surface that turns inside out or runs "
                "through itself."
            ),
            remedy=f"Send a factor from 0 to {np.floor(100.0 * largest) / 100.0:.2f}.",
        )
    return Caricature(
        coefficient=coefficient,
        before=before,
        after=after,
        factor=factor,
        shape=exaggeration.shape(after),
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
    """One coefficient of a person, to be varied."""

    def __init__(
        self, evaluator: ScapeEvaluator, shape: Shape, coefficient: int, height_m: float
    ) -> None:
        self._evaluator = evaluator
        self._shape = shape
        self._coefficient = coefficient
        self._height_m = height_m
        model = evaluator.model
        self._edges = mesh_topology(model.triangles, vertex_count=len(model.mean_vertices)).edges
        self._own = self._canonical(shape)
        self._own_crossing = self._soundness(self._own).crossing

    def shape(self, value: float) -> Shape:
        """The person with this value of the coefficient, as tall as before."""
        changed = self._shape.copy()
        changed[self._coefficient] = value
        return shape_with_height(self._evaluator, changed, self._height_m)

    def sound(self, value: float) -> bool:
        """Whether the surface stays one."""
        if abs(value) > MOST_DEVIATIONS:
            return False
        if abs(value) <= abs(self._shape[self._coefficient]):
            return True
        found = self._soundness(self._canonical(self.shape(value)))
        return (
            found.turned_over <= MOST_TURNED_OVER
            and found.crossing <= self._own_crossing + MOST_CROSSING
        )

    def farthest_sound(self) -> float:
        """The value farthest out, on the person's own side, before which all are sound."""
        own = float(self._shape[self._coefficient])
        side = float(np.sign(own))
        inner, outer = abs(own), abs(own) + _STEP
        while outer <= MOST_DEVIATIONS and self.sound(side * outer):
            inner, outer = outer, outer + _STEP
        while outer - inner > _TOLERANCE:
            middle = 0.5 * (inner + outer)
            if self.sound(side * middle):
                inner = middle
            else:
                outer = middle
        return side * inner

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


def _refused(*, reason: str, remedy: str) -> InvalidInputError:
    return InvalidInputError(code="factor-unusable", field="factor", reason=reason, remedy=remedy)
