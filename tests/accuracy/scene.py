"""What one picture of the suite shows: frozen descriptions, nothing computed."""

from dataclasses import dataclass, field
from enum import IntEnum, StrEnum

from fitter.vocabulary.choices import Gender

Rgb = tuple[float, float, float]
"""Linear light."""

DISTANT_M = 20.0
"""A lamp this far away lights the whole body alike."""


class Half(StrEnum):
    """Constants may be chosen on one half of the people; figures are reported on the other."""

    TUNING = "tuning"
    REPORTING = "reporting"


class Series(StrEnum):
    """Sets of pictures whose figures are printed apart."""

    PEOPLE = "people"
    LIGHTS = "lights"
    SAMPLE = "sample"
    CLOTHED = "clothed"
    PHONE = "phone"
    CLOTHED_PAIRS = "clothed-pairs"
    FOREIGN = "foreign"
    DRESSED = "dressed"


PAIRED_SERIES = frozenset({Series.PHONE, Series.CLOTHED_PAIRS})
"""A person from the front and from the side; fitted where they are asked for."""


class Kind(StrEnum):
    """The stance that ends an ordinary picture's name; ``OCCLUDED`` as in the paper's Fig. 4."""

    STANDING = "standing"
    OCCLUDED = "occluded"
    TURNED = "turned"


class FocalLength(StrEnum):
    """How a request learns the focal length."""

    GIVEN = "given"
    EXIF = "exif"
    MISSING = "missing"


class Wall(StrEnum):
    """The surface behind the person."""

    CANVAS = "canvas"
    PLASTER = "plaster"
    BRICK = "brick"
    BOARDS = "boards"
    STRIPES = "stripes"
    SHELVES = "shelves"
    HEDGE = "hedge"


class Floor(StrEnum):
    """The surface the person stands on."""

    CONCRETE = "concrete"
    WOOD = "wood"
    CARPET = "carpet"
    GRASS = "grass"


class Pattern(StrEnum):
    """What is woven into a garment or printed on it."""

    PLAIN = "plain"
    STRIPES = "stripes"
    CHECKS = "checks"


class Hair(StrEnum):
    """How hair is worn."""

    SHORT = "short"
    TIED = "tied"
    SHAVED = "shaved"


class Label(IntEnum):
    """What a pixel shows."""

    BACKGROUND = 0
    SKIN = 1
    HAIR = 2
    UPPER = 3
    LOWER = 4
    SHOES = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class Arm:
    """An arm, degrees. All zero hangs straight down with the palm inward.

    ``raised`` is the upper arm's angle from straight down in the chest's axes, in the direction
    ``forward`` (0 sideways, 90 to the front, -90 to the back); ``turn`` is its twist about itself,
    ``bend`` the elbow's, ``palm`` the forearm's (positive turns the palm to the back).
    """

    raised: float = 8.0
    forward: float = 0.0
    turn: float = 0.0
    bend: float = 8.0
    palm: float = 0.0
    curl: float = 13.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Leg:
    """A leg, degrees, in upright axes that turn with the person.

    ``raised`` and ``forward`` as for an arm; ``turn`` turns knee and foot outward, ``bend`` is the
    knee's, ``toe_out`` the foot's own turn, ``heel_up`` lifts the heel.
    """

    raised: float = 3.0
    forward: float = 0.0
    turn: float = 5.0
    bend: float = 3.0
    toe_out: float = 10.0
    heel_up: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Stance:
    """How a person stands: degrees about the body's axes at rest.

    Vectors are (bend forward, turn to the left, lean to the right). ``pelvis`` turns the whole
    body but for ``facing``, the turn of the person on the floor (positive to their left); legs are
    aimed regardless of ``pelvis``. ``free_leg`` names the leg whose knee is bent further until
    both feet touch the floor.
    """

    facing: float = 0.0
    pelvis: tuple[float, float, float] = (0.0, 0.0, 0.0)
    spine: tuple[float, float, float] = (0.0, 0.0, 0.0)
    chest: tuple[float, float, float] = (0.0, 0.0, 0.0)
    neck: tuple[float, float, float] = (0.0, 0.0, 0.0)
    head: tuple[float, float, float] = (0.0, 0.0, 0.0)
    left_arm: Arm = field(default_factory=Arm)
    right_arm: Arm = field(default_factory=Arm)
    left_leg: Leg = field(default_factory=Leg)
    right_leg: Leg = field(default_factory=Leg)
    free_leg: str = "left"


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """The camera: it looks at a height above the spot the person stands on.

    ``equivalent_mm`` is the focal length's whole 35 mm equivalent, as EXIF writes it; metres.
    """

    width: int = 480
    height: int = 640
    equivalent_mm: int = 50
    distance_m: float = 3.2
    height_m: float = 1.35
    aim_height_m: float = 0.9
    aim_aside_m: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Lamp:
    """A shining sphere.

    ``azimuth`` and ``elevation`` are degrees about the person's middle, azimuth 0 at the camera and
    positive to the right of the picture. ``strength`` is the radiance a white surface at the
    person's middle that faces the lamp would get from it.
    """

    azimuth: float = -45.0
    elevation: float = 35.0
    distance_m: float = 2.8
    radius_m: float = 0.06
    strength: float = 0.8


@dataclass(frozen=True, slots=True, kw_only=True)
class Lighting:
    """Lamps and light from all round.

    ``lamp`` is the light a fit should find, directional if it is ``DISTANT_M`` away; ``second`` is
    one it does not know of. ``ambient`` is the radiance from all round.
    """

    lamp: Lamp = field(default_factory=Lamp)
    second: Lamp | None = None
    ambient: Rgb = (0.25, 0.25, 0.25)


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """Wall and floor."""

    wall: Wall = Wall.PLASTER
    floor: Floor = Floor.CONCRETE
    wall_colour: Rgb = (0.42, 0.42, 0.40)
    floor_colour: Rgb = (0.28, 0.27, 0.26)
    wall_distance_m: float = 1.4


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """Skin, hair and underwear; ``clothes_relief_m`` is how far underwear stands off."""

    skin: Rgb = (0.58, 0.345, 0.24)
    hair: Hair = Hair.SHORT
    hair_colour: Rgb = (0.045, 0.028, 0.018)
    clothes_colour: Rgb = (0.03, 0.035, 0.06)
    clothes_relief_m: float = 0.0025


@dataclass(frozen=True, slots=True, kw_only=True)
class Cloth:
    """A garment's colours, linear, and how it hangs.

    ``ease_m`` is how far it stands off the body where it is widest; ``fall`` how steeply, in metres
    a metre downward, it falls back to a body that tapers below it: 0 hangs straight, less flares.
    """

    colour: Rgb
    second_colour: Rgb = (0.5, 0.5, 0.5)
    pattern: Pattern = Pattern.PLAIN
    ease_m: float = 0.03
    fall: float = 0.15
    fold_m: float = 0.006


@dataclass(frozen=True, slots=True, kw_only=True)
class Top:
    """A shirt, a blouse, a jacket or a dress.

    ``sleeve`` is the share of the arm from shoulder to wrist, 0 of tank tops; ``hem`` the height
    above the floor as a share of the stature, ``neckline_m`` how far it lies below the neck's root
    in front. ``cuffs`` gather sleeves and hem; ``opening_m`` is half the breadth that an open
    jacket shows of what is under it, at the hem.
    """

    cloth: Cloth
    sleeve: float = 0.4
    hem: float = 0.46
    neckline_m: float = 0.03
    cuffs: bool = False
    opening_m: float = 0.0
    clearance_m: float = 0.012


@dataclass(frozen=True, slots=True, kw_only=True)
class Bottom:
    """Trousers, or a skirt, whose legs are one.

    ``waist`` and ``hem`` are heights above the floor as shares of the stature; ``cuffs`` gather
    the legs at the hem.
    """

    cloth: Cloth
    waist: float = 0.585
    hem: float = 0.06
    skirt: bool = False
    cuffs: bool = False
    clearance_m: float = 0.006


@dataclass(frozen=True, slots=True, kw_only=True)
class Shoes:
    """Low shoes: their colour, their soles' colour, linear, and how thick the soles are."""

    colour: Rgb
    sole_colour: Rgb
    sole_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Outfit:
    """What is worn over the underwear, and its class in words; a dress is a top alone."""

    name: str
    top: Top | None = None
    bottom: Bottom | None = None
    jacket: Top | None = None
    shoes: Shoes | None = None

    @property
    def sole_m(self) -> float:
        """How far the feet stand above the floor."""
        return 0.0 if self.shoes is None else self.shoes.sole_m


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonSource:
    """A held-out person; ``stature_m`` is rounded, for the framing of their pictures."""

    name: str
    gender: Gender
    half: Half
    stature_m: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """One picture.

    ``seed`` is that of the clicks and the camera's noise; ``surface_seed`` that of skin, hair and
    room where pictures share them, else it is the same.
    """

    name: str
    person: str
    series: Series
    stance: Stance
    view: View = field(default_factory=View)
    lighting: Lighting = field(default_factory=Lighting)
    surroundings: Surroundings = field(default_factory=Surroundings)
    look: Look = field(default_factory=Look)
    focal_length: FocalLength = FocalLength.GIVEN
    outfit: Outfit | None = None
    seed: int = 0
    surface_seed: int | None = None
