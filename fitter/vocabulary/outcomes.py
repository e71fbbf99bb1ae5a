"""Words of a result."""

from dataclasses import dataclass
from enum import StrEnum

from fitter.vocabulary.choices import BodyRegion, Clothing, Covering, Facing


class Outcome(StrEnum):
    """Outcome of the optimisation."""

    CONVERGED = "converged"
    EVALUATION_LIMIT = "evaluation_limit"
    POOR_FIT = "poor_fit"


class Verdict(StrEnum):
    """Whether the picture bears out that a person was measured.

    `no_person`: nothing shows a person where the points are. `implausible`: a body was fitted, but
    the points, the mask or the picture contradict it. `outcome` is then `poor_fit`.
    """

    PLAUSIBLE = "plausible"
    IMPLAUSIBLE = "implausible"
    NO_PERSON = "no_person"


class FacingSource(StrEnum):
    """Source of the way a limb faces."""

    CALLER = "caller"
    ENERGY = "energy"
    PRIOR = "prior"


class FocalLengthSource(StrEnum):
    """Sources of the focal length, best first."""

    CALLER = "caller"
    EXIF_35MM = "exif_35mm_equivalent"
    EXIF_SENSOR = "exif_focal_length_and_sensor"
    ASSUMED = "assumed"


class StanceKind(StrEnum):
    """Stance of a person: on both feet, striding or on one foot, or neither."""

    STANDING = "standing"
    STRIDING = "striding"
    OTHER = "other"


class SeenFrom(StrEnum):
    """From where a person is seen; ``between`` front or back and side."""

    FRONT = "front"
    SIDE = "side"
    BACK = "back"
    BETWEEN = "between"


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbFacing:
    """Resolution of a limb's depth ambiguity (section 3.1).

    ``alternative_nats`` is by how much the best body or reading of the clicks with the limb facing
    the other way is less likely (the difference of two negative log-likelihoods), null where there
    is none worth mentioning; ``ambiguous`` says that the two are close.
    """

    limb: str
    facing: Facing
    source: FacingSource
    ambiguous: bool
    alternative_nats: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class WornRegion:
    """Most probable covering of a region of the person, and its probability.

    ``bare`` is covered by underwear at most, a head that shows mostly skin; hair and hats are
    ``loose``. ``ease_cm`` is how far loose clothes stand off the trunk, or off seat and legs, on
    average, where the outline shows them; null elsewhere.
    """

    region: BodyRegion
    kind: Covering
    probability: float
    ease_cm: float | None
    ease_standard_error_cm: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ClothingGuess:
    """Clothes as they look, in the word that a request may say of them, and why."""

    kind: Clothing
    reason: str
