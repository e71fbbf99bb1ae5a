"""Request of a fit: the person, the pictures of them and the caller's choices."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from fitter.vocabulary.choices import (
    Clothing,
    Cues,
    Facing,
    Gender,
    LightKind,
    OptimizerKind,
    PaperEnergy,
    SegmentationKind,
    ViewKind,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Click:
    """A clicked point, continuous pixels of the picture as a browser shows it.

    Attributes
    ----------
    occluded
        Whether the point is hidden, its place a guess.
    spread_m
        Standard deviation in each direction of the picture, metres on the body, of a point that was
        proposed by the detector; None of one that somebody clicked.
    """

    x: float
    y: float
    occluded: bool = False
    spread_m: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownMeasurement:
    """A measurement that the caller knows of the person.

    Attributes
    ----------
    value
        In the measurement's unit.
    standard_error
        With which it was taken; 0 holds it exactly.
    field
        Where the request has it, None for ``measurements``.
    """

    value: float
    standard_error: float = 0.0
    field: str | None = None

    def field_of(self, name: str) -> str:
        """The request field of the measurement of this name."""
        return self.field or f"measurements.{name}"


@dataclass(frozen=True, slots=True, kw_only=True)
class LightGuess:
    """The caller's coarse first light (section 5); the angles are those of ``Light``, radians."""

    kind: LightKind = LightKind.POINT
    azimuth: float | None = None
    elevation: float | None = None
    distance: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SaidClothing:
    """Clothes on the upper body and on seat and legs, as the caller says."""

    upper: Clothing = Clothing.AUTO
    lower: Clothing = Clothing.AUTO

    @property
    def both(self) -> frozenset[Clothing]:
        """Words on either."""
        return frozenset({self.upper, self.lower})


@dataclass(frozen=True, slots=True, kw_only=True)
class Person:
    """The person in the pictures.

    Attributes
    ----------
    height_m
        Stature in metres; None means the mean of the gender, or the most probable height of people
        with the known measurements, which is then reported as assumed.
    measurements
        What else is known of the person, by measurement name.
    """

    gender: Gender
    height_m: float | None = None
    measurements: Mapping[str, KnownMeasurement] = field(
        default_factory=dict[str, KnownMeasurement]
    )


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class View:
    """One picture of the person, what is known of it and how it is read.

    Attributes
    ----------
    image
        The encoded picture (JPEG, PNG, WebP or HEIC).
    clicks
        By canonical name: COCO-17 (``left_shoulder`` ...), ``neck``, ``head_top``, ``chin``,
        ``left_toe``, ``left_heel`` ...; left and right are the person's own. Points refer to pixels
        of the upright picture.
    kind
        From where the picture shows the person, who then stands as asked, if it was taken to be
        measured; None for any other picture. Pictures with a kind are checked as such.
    mask
        An encoded grey picture of the same size; above half is foreground. Replaces GrabCut.
    focal_length_px, focal_length_35mm
        At most one; pixels of the upright picture, or the 35 mm equivalent.
    cues
        What is compared with the picture.
    clothing
        How clothes lie, all or by region; nothing said, it is found in the picture.
    limb_facing
        The caller's word by limb name (``left_forearm`` ...).
    complete_clicks
        Whether the detector proposes the points that were not clicked.
    slant_hints
        Whether the detector says how limbs slant in depth.
    """

    image: bytes
    clicks: Mapping[str, Click]
    kind: ViewKind | None = None
    mask: bytes | None = None
    focal_length_px: float | None = None
    focal_length_35mm: float | None = None
    cues: Cues = Cues.SES
    clothing: Clothing | SaidClothing = Clothing.AUTO
    light: LightGuess = field(default_factory=LightGuess)
    limb_facing: Mapping[str, Facing] = field(default_factory=dict[str, Facing])
    complete_clicks: bool = False
    segmentation: SegmentationKind = SegmentationKind.SEEDED_GRABCUT
    slant_hints: bool = True


@dataclass(frozen=True, slots=True, kw_only=True)
class Paper:
    """The paper's own method, without what was added to it (:mod:`fitter.fits.paper`).

    Attributes
    ----------
    energies
        The terms that count; shading only where ``cues`` ask for it.
    free_height
        Whether the height is found too, as in the paper's Fig. 5, and not held.
    """

    energies: frozenset[PaperEnergy] = frozenset(PaperEnergy)
    free_height: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Choices:
    """Choices of how a fit is done, whatever the pictures.

    Attributes
    ----------
    paper
        Fits one picture as the paper does; None as this package does.
    force
        Whether measurements are given even if the evidence contradicts a person.
    max_pixels
        Largest picture accepted, checked before decoding.
    """

    optimizer: OptimizerKind = OptimizerKind.GAUSS_NEWTON
    paper: Paper | None = None
    force: bool = False
    max_pixels: int = 200_000_000


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class FitRequest:
    """One person and one to six pictures of them."""

    person: Person
    views: tuple[View, ...]
    choices: Choices = field(default_factory=Choices)
