"""Measurements of ANSUR II on a MakeHuman body at rest, as sums of lengths of sparse differences.

Every measurement is a sum of distances between weighted vertices plus signed coordinate
differences: both are linear in the targets' coefficients before the norm, which makes value and
derivative cheap. Girths are hulls held to mesh edges (:mod:`fitter.training.surveys.cuts`).

The rest pose spreads legs and arms, so heights are summed along the leg (hip, knee, ankle, sole)
below the hip and taken upright above it, and arm lengths from joint to joint. Names and definitions
are the survey's; the left side is measured.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Integer
from scipy import sparse

from fitter.arrays import Triangles, Vector3, Vertices
from fitter.body.model import SparseRows
from fitter.training.makehuman.meshes import BaseMesh
from fitter.training.surveys.cuts import HullCut, limb_cut, trunk_cut

Row = Mapping[int, float]
"""A weighted sum of source vertices."""

UP = np.array([0.0, 1.0, 0.0])

SCAN_CUTS = 9
"""Cuts tried along a limb for its largest or smallest girth: one every 1 to 2 cm."""

BELOW_CROTCH = 0.02
"""Metres below the crotch where the thigh is measured; at the crotch the plane cuts the groin."""

LEVEL_GIRTHS = {
    "chestcircumference": "nipple",
    "waistcircumference": "navel",
    "buttockcircumference": "seat",
}

LIMB_GIRTHS = {
    "calfcircumference": ("knee", "ankle", 0.22, 0.6, "largest"),
    "anklecircumference": ("knee", "ankle", 0.75, 0.98, "smallest"),
    "bicepscircumference": ("shoulder", "elbow", 0.4, 0.7, "largest"),
    "forearmcircumference": ("elbow", "wrist", 0.1, 0.5, "largest"),
    "wristcircumference": ("elbow", "wrist", 0.8, 1.02, "smallest"),
    "neckcircumference": ("neck", "head", 0.2, 1.0, "smallest"),
}

CALIPERS = {
    "hipbreadth": ("buttockcircumference", 0),
    "waistbreadth": ("waistcircumference", 0),
    "waistdepth": ("waistcircumference", 2),
    "chestdepth": ("chestcircumference", 2),
    "buttockdepth": ("buttockcircumference", 2),
    "headbreadth": ("headcircumference", 0),
    "headlength": ("headcircumference", 2),
}
"""Extent of a girth's hull along x (breadth) or z (depth)."""

UPRIGHT_HEIGHTS = {
    "stature": "crown",
    "cervicaleheight": "cervicale",
    "acromialheight": "acromion",
    "suprasternaleheight": "neck",
    "chestheight": "nipple",
    "waistheightomphalion": "navel",
    "buttockheight": "seat",
    "crotchheight": "crotch",
}

LENGTHS = {
    "acromionradialelength": ("acromion", "elbow"),
    "radialestylionlength": ("elbow", "wrist"),
    "handlength": ("wrist", "finger_tip"),
    "biacromialbreadth": ("acromion", "right_acromion"),
}

JOINT_GROUPS = {
    "hip": "joint-l-upper-leg",
    "knee": "joint-l-knee",
    "ankle": "joint-l-ankle",
    "shoulder": "joint-l-shoulder",
    "elbow": "joint-l-elbow",
    "wrist": "joint-l-hand",
    "neck": "joint-neck",
    "head": "joint-head",
}

LEFT_LANDMARKS = ("nipple", "acromion", "finger_tip", "toe", "heel", "eye")
MIDDLE_LANDMARKS = ("navel", "seat", "crown", "cervicale", "neck", "crotch")

WEIGHT = "weightkg"

MEASUREMENTS = (
    *LEVEL_GIRTHS,
    "headcircumference",
    "thighcircumference",
    *LIMB_GIRTHS,
    *CALIPERS,
    *UPRIGHT_HEIGHTS,
    "lateralfemoralepicondyleheight",
    "footlength",
    *LENGTHS,
    WEIGHT,
)
"""All measurements in order; weight, which is a volume, comes last."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class LinearForms:
    """The measurements but for weight, made linear for one placement of the cuts.

    Attributes
    ----------
    differences
        (s, v) sparse: row r takes the difference of two weighted sums of source vertices.
    axis
        (s,) -1: the row counts by the length of the difference; 0, 1, 2: by that coordinate.
    measurement
        (s,) the measurement a row adds to.
    """

    differences: sparse.csr_array
    axis: Integer[np.ndarray, " s"]
    measurement: Integer[np.ndarray, " s"]


def named_rows(base: BaseMesh, landmarks: SparseRows) -> dict[str, Row]:
    """Joints and landmarks by the short names used here, as rows over the source vertices."""
    rows: dict[str, Row] = {
        name: dict.fromkeys(base.groups[group].tolist(), 1.0 / len(base.groups[group]))
        for name, group in JOINT_GROUPS.items()
    }

    def landmark(name: str) -> Row:
        row = landmarks.names.index(name)
        span = slice(landmarks.pointers[row], landmarks.pointers[row + 1])
        vertices = base.body_vertex_ids[landmarks.indices[span]]
        return dict(zip(vertices.tolist(), landmarks.weights[span].tolist(), strict=True))

    rows |= {name: landmark(f"left_{name}") for name in LEFT_LANDMARKS}
    # The neck's joint is needed as an axis, its pit as a landmark.
    rows |= {("throat" if name == "neck" else name): landmark(name) for name in MIDDLE_LANDMARKS}
    return rows | {"sole": landmark("sole_left"), "right_acromion": landmark("right_acromion")}


def place_measurements(
    base: BaseMesh, trunk: Triangles, rows: Mapping[str, Row], source: Vertices
) -> LinearForms:
    """Place all cuts on one body and write its measurements as linear forms.

    Parameters
    ----------
    base
        The base mesh.
    trunk
        The triangles of the body without its arms.
    rows
        From :func:`named_rows`.
    source
        (v, 3) source vertices of the body, body frame, metres.
    """
    points = {
        name: np.sum([weight * source[vertex] for vertex, weight in row.items()], axis=0)
        for name, row in rows.items()
    }
    cuts = place_cuts(base, trunk, points, source)
    entries = [
        (MEASUREMENTS.index(name), axis, row)
        for name, axis, row in _forms(base, rows, cuts, source)
    ]
    columns = [list(row) for _, _, row in entries]
    return LinearForms(
        differences=sparse.csr_array(
            (
                np.concatenate([list(row.values()) for _, _, row in entries]),
                np.concatenate(columns),
                np.cumsum([0, *(len(column) for column in columns)]),
            ),
            shape=(len(entries), len(source)),
        ),
        axis=np.array([axis for _, axis, _ in entries]),
        measurement=np.array([measurement for measurement, _, _ in entries]),
    )


def place_cuts(
    base: BaseMesh, trunk: Triangles, points: Mapping[str, Vector3], source: Vertices
) -> dict[str, HullCut]:
    """The cut of every girth on one body, over body vertices."""
    body = base.body(source)

    def cut(point: Vector3, normal: Vector3) -> HullCut:
        return limb_cut(body, base.triangles, point, normal)

    def scan(start: Vector3, end: Vector3, normal: Vector3, selection: str) -> HullCut:
        cuts = [cut(point, normal) for point in np.linspace(start, end, SCAN_CUTS)]
        girths = [candidate.girth(body) for candidate in cuts]
        return cuts[int(np.argmax(girths) if selection == "largest" else np.argmin(girths))]

    found: dict[str, HullCut] = {}
    for name, level in LEVEL_GIRTHS.items():
        middle = points[level] * [0.0, 1.0, 0.0] + points["hip"] * [0.0, 0.0, 1.0]
        found[name] = trunk_cut(body, trunk, middle, UP)
    brow = points["head"] * [0.0, 0.0, 1.0] + points["eye"] * UP
    crown = points["head"] * [0.0, 0.0, 1.0] + points["crown"] * UP
    found["headcircumference"] = scan(
        brow + 0.25 * (crown - brow), brow + 0.6 * (crown - brow), UP, "largest"
    )
    femur = points["knee"] - points["hip"]
    share = (points["hip"][1] - points["crotch"][1] + BELOW_CROTCH) / -femur[1]
    found["thighcircumference"] = cut(points["hip"] + share * femur, _unit(femur))
    for name, (start, end, low, high, selection) in LIMB_GIRTHS.items():
        bone = points[end] - points[start]
        found[name] = scan(
            points[start] + low * bone, points[start] + high * bone, _unit(bone), selection
        )
    return found


def _forms(
    base: BaseMesh, rows: Mapping[str, Row], cuts: Mapping[str, HullCut], source: Vertices
) -> Iterator[tuple[str, int, Row]]:
    """(measurement, axis, difference) of every term."""
    body = base.body(source)
    corners = {name: _corner_rows(base, cut) for name, cut in cuts.items()}
    for name, ring in corners.items():
        for first, second in zip(ring, ring[1:] + ring[:1], strict=True):
            yield name, -1, _difference(first, second)
    for name, (girth, axis) in CALIPERS.items():
        along = cuts[girth].corners(body)[:, axis]
        ring = corners[girth]
        yield name, axis, _difference(ring[int(np.argmax(along))], ring[int(np.argmin(along))])
    thigh = _difference(rows["hip"], rows["knee"])
    shin = _difference(rows["knee"], rows["ankle"])
    foot = _difference(rows["ankle"], rows["sole"])
    for name, point in UPRIGHT_HEIGHTS.items():
        top = rows["throat" if point == "neck" else point]
        yield name, 1, _difference(top, rows["hip"])
        yield from ((name, -1, thigh), (name, -1, shin), (name, 1, foot))
    yield from (
        ("lateralfemoralepicondyleheight", -1, shin),
        ("lateralfemoralepicondyleheight", 1, foot),
    )
    yield "footlength", -1, _difference(rows["toe"], rows["heel"])
    for name, (first, second) in LENGTHS.items():
        yield name, -1, _difference(rows[first], rows[second])


def _corner_rows(base: BaseMesh, cut: HullCut) -> list[Row]:
    ids = base.body_vertex_ids[cut.edges]
    return [
        {int(first): 1.0 - share, int(second): share}
        for (first, second), share in zip(ids, cut.share.tolist(), strict=True)
    ]


def _difference(first: Row, second: Row) -> Row:
    merged = dict(first)
    for vertex, weight in second.items():
        merged[vertex] = merged.get(vertex, 0.0) - weight
    return merged


def _unit(vector: Vector3) -> Vector3:
    return vector / np.linalg.norm(vector)
