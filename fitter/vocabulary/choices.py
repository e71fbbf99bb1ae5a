"""Choices of a caller."""

from enum import StrEnum


class Gender(StrEnum):
    """Which of the two trained bodies to fit: the paper learns a shape space for each."""

    FEMALE = "female"
    MALE = "male"


class Cues(StrEnum):
    """Image evidence (section 6): silhouette and edges (E1), or these and shading (E2)."""

    SE = "SE"
    SES = "SES"


class OptimizerKind(StrEnum):
    """Optimiser of the energy: a fast one, or the paper's."""

    GAUSS_NEWTON = "gauss_newton"
    SIMPLEX = "simplex"


class PaperEnergy(StrEnum):
    """The paper's terms (section 6): E1 is the sum of the first three, E2 of all."""

    SILHOUETTE = "silhouette"
    EDGES = "edges"
    PENETRATION = "penetration"
    SHADING = "shading"


class SegmentationKind(StrEnum):
    """Method of cutting out the person where the caller sends no mask.

    ``seeded_grabcut``: from a tri-map round the detector's mask, where the detector is installed
    and finds the person. ``grabcut``: from a tri-map round the body, as in the paper.
    """

    SEEDED_GRABCUT = "seeded_grabcut"
    GRABCUT = "grabcut"


class LightKind(StrEnum):
    """A near point light (indoors) or a distant directional one (outdoors); section 5."""

    POINT = "point"
    DIRECTIONAL = "directional"


class Clothing(StrEnum):
    """Looseness of the clothes.

    ``auto``: what is covered, and whether loosely, is found in the picture. ``tight``: the outline
    is the body's own. ``loose``: the outline bounds the body from outside, by an ease that is not
    known; where skin shows, which the person's own face and hands tell, it is tight, and shading
    looks at skin alone. ``outer``: loose, with a jacket, coat, vest or open shirt over a top; of
    seat and legs it says nothing.
    """

    AUTO = "auto"
    TIGHT = "tight"
    LOOSE = "loose"
    OUTER = "outer"


class Covering(StrEnum):
    """Cover of a region: no more than underwear, close to the body, or at a distance."""

    BARE = "bare"
    CLOSE = "close"
    LOOSE = "loose"


class BodyRegion(StrEnum):
    """Region of the body whose cover a result reports; that of the head is hair or a hat."""

    HEAD = "head"
    UPPER = "upper"
    ARMS = "arms"
    LOWER = "lower"
    LEGS = "legs"
    FEET = "feet"


class Posture(StrEnum):
    """Knowledge of how the person stands.

    ``measured`` people were asked to stand upright, straight and still on both feet.
    """

    ANY = "any"
    MEASURED = "measured"


class Facing(StrEnum):
    """Whether the far end of a limb is nearer to the camera than its near end, or farther."""

    TOWARD = "toward"
    AWAY = "away"


class ViewKind(StrEnum):
    """From where a person is to be seen; ``side`` is either side, ``other`` is any view."""

    FRONT = "front"
    SIDE = "side"
    BACK = "back"
    OTHER = "other"


class BoneNames(StrEnum):
    """Names of a skeleton's bones: those of ``/v1/body-models``, or of other programs."""

    MAQUETTE = "maquette"
    MIXAMO = "mixamo"
    UNREAL = "unreal"
    VRM = "vrm"
