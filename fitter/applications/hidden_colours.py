"""Colours of skin and cloth that no picture shows, from those that it shows.

What is seen falls into pieces of plain colour (:mod:`fitter.applications.pieces`). Clothes and
limbs go round: over what is hidden the share of each piece is carried on smoothly, much farther
round trunk and limbs than along them, and the piece with the largest share is worn there, so that
hems, sleeves and belts meet behind. Pieces of one colour count as one. About the pelvis hems rise
from between the legs to the hips: there a hidden point is also like the one seen straight before
or behind it. Where hidden meets seen its light follows what is seen
(:func:`fitter.applications.picture_look.extend_light`).

The head's back is hair, or a hat: what the picture shows about the crown. Ears are skin, and so is
a face that is not seen.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import qdldl
from jaxtyping import Bool, Float, Integer
from scipy import sparse
from scipy.spatial import KDTree

from fitter.applications.picture_surface import DARKEST, Colours, SurfacePoints, smooth_step
from fitter.applications.pieces import cloth_colours, pieces_of, vertex_areas
from fitter.applications.rings import Region, RingCoordinates, landmark
from fitter.arrays import Vector3
from fitter.body.model import BodyModel
from fitter.numerics.rotations import unit_vectors

ROUND = 200.0
"""Conductivity round trunk and limbs, as a multiple of that along them: a band of 4 cm that is seen
at both sides reaches round a back of 35."""

LEAST_PIECE_M2 = 5e-4
"""Smaller pieces are no clothes; the tip of a shoe below trousers has 10 cm²."""

SAME_CLOTH = 10.0
"""Difference in CIELAB with less brightness up to which pieces are one cloth, or skin."""

MOST_LIGHT, MOST_HUE, LEAST_TINT = 1.3, 0.25, 0.4
"""Or logarithms of the most that light differs by, of what channels differ by in that, and of what
they differ by in a colour: skin in the shade loses chroma, but greys are different cloths."""

WITHIN = 0.75
"""Share of a region from which a point is told by that alone."""

SHADE_M = 0.05
"""Deviation of heights from which what is seen of a piece tells how it is shaded from above."""

BELOW_NAVEL_M, BELOW_CROTCH_M = (0.03, 0.08), (0.1, 0.16)
"""Over which a point begins to be like the one before it, and ends: a bare back has no navel, and
cloth goes round legs."""

BESIDE = (0.3, 0.6)
"""Shares of the way to the shoulder over which that begins above: necklines are another behind."""

THROUGH_M, ASIDE_M, NEAREST = 0.04, 0.03, 4
"""Distance round the body over which that is forgotten; most between two such points as seen from
before; how many are read."""

TWO_SHARE = 0.9
"""Share of skin and one cloth where that holds: an open jacket shows another."""

_LEAST_SHARE = 1e-9
# Of every piece everywhere: a part that hangs together with none has the mean of all.


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Worn:
    """What is worn all over a body.

    Attributes
    ----------
    shares
        (m, g) of each cloth, hair and skin at each vertex.
    colours
        (m, g, 3) linear, of each there.
    """

    shares: Float[np.ndarray, "m g"]
    colours: Float[np.ndarray, "m g 3"]

    @classmethod
    def of(
        cls,
        model: BodyModel,
        seen: Bool[np.ndarray, " m"],
        colours: Float[np.ndarray, "m 3"],
        crown: Vector3 | None,
    ) -> "Worn":
        """Carry on what is seen.

        Parameters
        ----------
        seen, colours
            Which vertices are seen, at least one, and their linear colours.
        crown
            Colour about the crown; None where the picture does not show it.
        """
        areas = vertex_areas(model)
        piece = pieces_of(model, seen, colours)
        sizes = np.bincount(piece[seen], areas[seen])
        large = sizes >= min(LEAST_PIECE_M2, sizes.max())
        piece = np.where(np.append(large, False)[piece], piece, -1)
        # Numbers without gaps, and -1 for none.
        piece = np.unique(np.append(piece, -1), return_inverse=True)[1][:-1] - 1
        plain = [_shaded(model, piece == each, colours) for each in range(piece.max() + 1)]
        rings = RingCoordinates.of(model)
        skin = _skin(rings, piece, hair=crown is not None)
        if skin is not None:
            above_chin = model.mean_vertices[:, 1] > landmark(model, "chin")[1]
            bare = (rings.shares[Region.FACE] > WITHIN) & above_chin
            if seen[rings.features > WITHIN].any():
                # What hides a forehead may be hair.
                bare &= rings.features < 1.0 - WITHIN
            piece[(piece < 0) & bare] = skin
        if crown is not None:
            piece[(piece < 0) & (rings.shares[Region.SCALP] > WITHIN)] = len(plain)
            plain.append(np.tile(crown, (len(piece), 1)))
        colours, given = np.stack(plain), piece >= 0
        cloth = _alike(colours.mean(axis=1), np.bincount(piece[given], areas[given], len(plain)))
        is_skin = np.zeros(len(plain), dtype=bool) if skin is None else cloth == cloth[skin]
        shares = _carried_on(model, piece, cloth, is_skin) + _LEAST_SHARE
        own = np.arange(cloth.max() + 1)[:, None] == cloth
        totals = shares @ own.T
        sums = np.einsum("mk,gk,kmc->mgc", shares, own, colours, optimize=True)
        return cls(shares=totals, colours=sums / totals[..., None])

    def at(self, points: SurfacePoints) -> Colours:
        """Linear colours of points."""
        worn = self.shares.argmax(axis=1)
        colours = points.of(self.colours[np.arange(len(worn)), worn])
        of_corners = worn[points.corners]
        mixed = np.flatnonzero((of_corners != of_corners[:, :1]).any(axis=1))
        worn = points.some(mixed).of(self.shares).argmax(axis=1)
        for each in np.unique(worn):
            own = mixed[worn == each]
            colours[own] = points.some(own).of(np.ascontiguousarray(self.colours[:, each]))
        return colours


def _shaded(
    model: BodyModel, own: Bool[np.ndarray, " m"], colours: Float[np.ndarray, "m 3"]
) -> Float[np.ndarray, "m 3"]:
    """Linear colours of a piece at all heights: light from above stays, prints go."""
    height, worn = model.mean_vertices[:, 1], cloth_colours(colours)
    plain = own & (np.linalg.norm(worn - np.median(worn[own], axis=0), axis=1) < SAME_CLOTH)
    if not plain.any():
        # No thread of a pattern need have its median colour.
        plain = own
    away = np.clip(height, height[plain].min(), height[plain].max()) - height[plain].mean()
    mean = colours[plain].mean(axis=0)
    spread = np.sum(away[plain] ** 2 + SHADE_M**2)
    return mean + away[:, None] * (away[plain] @ (colours[plain] - mean) / spread)


def _skin(rings: RingCoordinates, piece: Integer[np.ndarray, " m"], *, hair: bool) -> int | None:
    """The piece that covers most of the face, or else of the hands, if any.

    From behind hands come first: what is seen of the head is hair.
    """
    from_behind = hair and not (piece[rings.features > WITHIN] >= 0).any()
    for region in (Region.FACE, Region.HANDS)[:: -1 if from_behind else 1]:
        own = piece[(piece >= 0) & (rings.shares[region] > 0.5)]
        if len(own):
            return int(np.bincount(own).argmax())
    return None


def _alike(
    plain: Float[np.ndarray, "k 3"], areas: Float[np.ndarray, " k"]
) -> Integer[np.ndarray, " k"]:
    """The cloth that each piece is of, by number; the largest pieces tell them apart."""
    worn, light = cloth_colours(plain), np.log(np.maximum(plain, DARKEST))
    cloth, first = np.zeros(len(plain), dtype=np.intp), list[int]()
    for each in np.argsort(-areas).tolist():
        apart = np.linalg.norm(worn[first] - worn[each], axis=1)
        ratios = light[first] - light[each]
        same_hue = (np.ptp(ratios, axis=1) < MOST_HUE) & (np.ptp(light[each]) > LEAST_TINT)
        alike = (apart < SAME_CLOTH) | (same_hue & (np.abs(ratios).max(axis=1) < MOST_LIGHT))
        cloth[each] = np.where(alike, apart, np.inf).argmin() if alike.any() else len(first)
        if not alike.any():
            first.append(each)
    return cloth


def _carried_on(
    model: BodyModel,
    piece: Integer[np.ndarray, " m"],
    cloth: Integer[np.ndarray, " k"],
    is_skin: Bool[np.ndarray, " k"],
) -> Float[np.ndarray, "m k"]:
    """Shares of pieces at all vertices: one where they are, and harmonic in between."""
    shares = np.zeros((len(piece), len(cloth)))
    given, hidden = np.flatnonzero(piece >= 0), np.flatnonzero(piece < 0)
    shares[given, piece[given]] = 1.0
    stiffness = _stiffness(model)[hidden]
    likeness, opposite = _straight_through(
        model, given, hidden, cloth[piece[given]], is_skin[piece[given]]
    )
    pull = likeness[:, None] * (opposite @ shares) - stiffness @ shares
    matrix = stiffness[:, hidden] + sparse.diags_array(likeness + _LEAST_SHARE)
    solver = qdldl.Solver(sparse.csc_matrix(sparse.triu(matrix)), upper=True)
    for each in range(len(cloth)):
        shares[hidden, each] = solver.solve(np.ascontiguousarray(pull[:, each]))
    return np.clip(shares, 0.0, 1.0)


@lru_cache(maxsize=2)
def _stiffness(model: BodyModel) -> sparse.csr_array:
    """(m, m) of linear elements on the mean body that conduct :data:`ROUND` times as well round.

    ∫ ∇u · D ∇v with D = ROUND (I - w w') + w w', w the unit gradient of the position along.
    """
    rings, triangles = RingCoordinates.of(model), model.triangles
    corners = model.mean_vertices[triangles]
    opposite = np.roll(corners, 1, axis=1) - np.roll(corners, -1, axis=1)
    normals = np.cross(opposite[:, 0], opposite[:, 1])
    doubled = np.linalg.norm(normals, axis=1)
    gradients = np.cross((normals / doubled[:, None])[:, None], opposite) / doubled[:, None, None]
    along = np.einsum("fk,fkd->fd", rings.along_m[rings.region[:, None], triangles], gradients)
    steep = np.linalg.norm(along, axis=1)
    # On top of shoulders and feet, in hands and scalp nothing leads along.
    more = (ROUND - 1.0) * np.minimum(steep, 1.0) ** 2
    along = np.einsum("fkd,fd->fk", gradients, unit_vectors(along))
    products = (1.0 + more)[:, None, None] * np.einsum("fkd,fld->fkl", gradients, gradients)
    products -= more[:, None, None] * along[:, :, None] * along[:, None, :]
    products *= 0.5 * doubled[:, None, None]
    rows, columns = np.repeat(triangles, 3, axis=1), np.tile(triangles, (1, 3))
    shape = (len(model.mean_vertices),) * 2
    return sparse.coo_array((products.ravel(), (rows.ravel(), columns.ravel())), shape).tocsr()


def _straight_through(
    model: BodyModel,
    given: Integer[np.ndarray, " s"],
    hidden: Integer[np.ndarray, " h"],
    cloth: Integer[np.ndarray, " s"],
    is_skin: Bool[np.ndarray, " s"],
) -> tuple[Float[np.ndarray, " h"], sparse.csr_array]:
    """How strongly hidden vertices are like those straight before or behind, and (h, m) which."""
    areas, likeness = vertex_areas(model), np.zeros(len(hidden))
    for zone in _zones(model):
        seen = (zone * areas)[given]
        worn = np.bincount(cloth, seen * ~is_skin).max() + seen[is_skin].sum()
        if is_skin.any() and worn >= TWO_SHARE * seen.sum():
            likeness += zone[hidden]
    from_front = model.mean_vertices[:, :2]
    apart, nearest = KDTree(from_front[given]).query(from_front[hidden], NEAREST)
    weights = 1.0 / np.maximum(apart, 1e-3)
    weights /= weights.sum(axis=1, keepdims=True)
    likeness *= ROUND / THROUGH_M**2 * areas[hidden] * (apart[:, 0] < ASIDE_M)
    # Those that are missing are infinitely far away.
    nearest = given[np.minimum(nearest, len(given) - 1)]
    starts = np.arange(0, nearest.size + 1, NEAREST)
    which = sparse.csr_array((weights.ravel(), nearest.ravel(), starts), (len(hidden), len(areas)))
    return likeness, which


@lru_cache(maxsize=2)
def _zones(model: BodyModel) -> Float[np.ndarray, "2 m"]:
    """Weights of the pelvis down to the tops of the legs, and of the sides of what is above it."""
    rings, height = RingCoordinates.of(model), model.mean_vertices[:, 1]
    above = 1.0 - smooth_step(landmark(model, "navel")[1] - height, *BELOW_NAVEL_M)
    legs = smooth_step(landmark(model, "crotch")[1] - height, *BELOW_CROTCH_M)
    aside = np.abs(model.mean_vertices[:, 0]) / landmark(model, "left_shoulder")[0]
    sides = above * smooth_step(aside, *BESIDE)
    return np.stack([1.0 - above - legs, sides]) * rings.shares[Region.TRUNK]
