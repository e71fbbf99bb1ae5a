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
    """How the energy is minimised: fast, or as the paper does."""

    GAUSS_NEWTON = "gauss_newton"
    SIMPLEX = "simplex"


class PaperEnergy(StrEnum):
    """The paper's terms (section 6): E1 is the sum of the first three, E2 of all."""

    SILHOUETTE = "silhouette"
    EDGES = "edges"
    PENETRATION = "penetration"
    SHADING = "shading"


class SegmentationKind(StrEnum):
    """How the person is cut out where the caller sends no mask.

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
    """How clothes lie.

    ``auto``: what is covered, and whether loosely, is found in the picture. ``tight``: the outline
    is the body's own. ``loose``: the outline bounds the body from outside, by an ease that is not
    known; where skin shows, which the person's own face and hands tell, it is tight, and shading
    looks at skin alone.
    """

    AUTO = "auto"
    TIGHT = "tight"
    LOOSE = "loose"


class ClothedRegion(StrEnum):
    """What clothing can be said of alone: trunk with arms, and seat with legs."""

    UPPER = "upper"
    LOWER = "lower"


class Covering(StrEnum):
    """How a region is covered: not by more than underwear, closely, or at a distance."""

    BARE = "bare"
    CLOSE = "close"
    LOOSE = "loose"


class BodyRegion(StrEnum):
    """Of what a result says how it is covered; the head by hair or a hat."""

    HEAD = "head"
    UPPER = "upper"
    ARMS = "arms"
    LOWER = "lower"
    LEGS = "legs"
    FEET = "feet"


class Posture(StrEnum):
    """What is known of how the person stands.

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
