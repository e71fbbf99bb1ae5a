"""The people of the suite: who they are and how they look."""

from collections.abc import Mapping
from dataclasses import dataclass

from fitter.vocabulary.choices import Gender
from tests.accuracy.scene import Hair, Half, Look, PersonSource, Rgb

_PALE, _FAIR, _TANNED, _BROWN, _DARK = (
    (0.66, 0.45, 0.36),
    (0.58, 0.36, 0.26),
    (0.47, 0.28, 0.185),
    (0.29, 0.16, 0.1),
    (0.15, 0.08, 0.052),
)
_BLACK, _DARK_BROWN, _CHESTNUT, _BLOND, _GREY = (
    (0.016, 0.012, 0.01),
    (0.05, 0.03, 0.018),
    (0.13, 0.065, 0.03),
    (0.3, 0.2, 0.09),
    (0.34, 0.33, 0.32),
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Sitter:
    """A person with their look; ``arms`` and ``legs`` are the degrees by which a thick body needs
    its limbs raised farther than a slim one."""

    source: PersonSource
    look: Look
    arms: float
    legs: float


def _sitter(
    name: str,
    half: Half,
    stature_m: float,
    skin: Rgb,
    hair: Hair,
    hair_colour: Rgb,
    clothes_colour: Rgb,
    *,
    arms: float = 0.0,
    legs: float = 0.0,
) -> Sitter:
    gender = Gender.FEMALE if name.startswith("woman") else Gender.MALE
    return Sitter(
        source=PersonSource(name=name, gender=gender, half=half, stature_m=stature_m),
        look=Look(skin=skin, hair=hair, hair_colour=hair_colour, clothes_colour=clothes_colour),
        arms=arms,
        legs=legs,
    )


_T, _R = Half.TUNING, Half.REPORTING
_SHORT, _TIED, _SHAVED = Hair.SHORT, Hair.TIED, Hair.SHAVED

_WINE, _NAVY, _TEAL, _COAL, _SAND, _RUST, _SLATE, _MOSS = (
    (0.1, 0.012, 0.025),
    (0.015, 0.025, 0.09),
    (0.03, 0.1, 0.09),
    (0.02, 0.02, 0.023),
    (0.42, 0.36, 0.28),
    (0.28, 0.07, 0.03),
    (0.2, 0.22, 0.25),
    (0.06, 0.08, 0.03),
)

SITTERS = (
    _sitter("woman_young_thin", _T, 1.75, _BROWN, _TIED, _BLACK, _TEAL),
    _sitter("woman_young_heavy", _T, 1.65, _FAIR, _TIED, _CHESTNUT, _NAVY, arms=5.0, legs=2.5),
    _sitter("woman_middle_aged_thin", _T, 1.61, _TANNED, _SHORT, _DARK_BROWN, _COAL),
    _sitter("woman_middle_aged_middling", _T, 1.61, _FAIR, _SHORT, _BLOND, _WINE, arms=2.0),
    _sitter("woman_old_middling", _T, 1.56, _PALE, _SHORT, _GREY, _SLATE, legs=1.0),
    _sitter("woman_old_heavy", _T, 1.59, _TANNED, _TIED, _GREY, _SAND, arms=9.0, legs=4.0),
    _sitter("man_young_thin", _T, 1.74, _DARK, _SHAVED, _BLACK, _SAND),
    _sitter("man_young_heavy", _T, 1.74, _FAIR, _SHORT, _CHESTNUT, _COAL, arms=8.0, legs=4.0),
    _sitter("man_middle_aged_thin", _T, 1.64, _TANNED, _SHORT, _BLACK, _RUST),
    _sitter("man_middle_aged_middling", _T, 1.77, _PALE, _SHORT, _DARK_BROWN, _MOSS, arms=3.0),
    _sitter("man_old_middling", _T, 1.65, _PALE, _SHAVED, _GREY, _NAVY, arms=3.0),
    _sitter("man_old_heavy", _T, 1.86, _BROWN, _SHORT, _GREY, _SLATE, arms=13.0, legs=5.0),
    _sitter("woman_193_young_thin", _R, 1.57, _FAIR, _SHORT, _DARK_BROWN, _RUST),
    _sitter("woman_109_young_heavy", _R, 1.56, _DARK, _TIED, _BLACK, _TEAL, arms=5.0, legs=2.5),
    _sitter("woman_114_middle_aged_thin", _R, 1.72, _PALE, _TIED, _CHESTNUT, _SLATE),
    _sitter("woman_101_middle_aged_middling", _R, 1.53, _BROWN, _SHORT, _BLACK, _SAND, arms=2.0),
    _sitter("woman_102_old_middling", _R, 1.6, _TANNED, _TIED, _GREY, _MOSS, legs=1.0),
    _sitter("woman_100_old_heavy", _R, 1.68, _FAIR, _SHORT, _GREY, _NAVY, arms=9.0, legs=4.0),
    _sitter("man_105_young_thin", _R, 1.76, _PALE, _SHORT, _BLOND, _WINE),
    _sitter("man_115_young_heavy", _R, 1.82, _BROWN, _SHAVED, _BLACK, _NAVY, arms=8.0, legs=4.0),
    _sitter("man_126_middle_aged_thin", _R, 1.9, _FAIR, _SHORT, _CHESTNUT, _COAL),
    _sitter("man_122_middle_aged_middling", _R, 1.62, _DARK, _SHORT, _BLACK, _TEAL, arms=3.0),
    _sitter("man_106_old_middling", _R, 1.76, _TANNED, _SHORT, _GREY, _RUST, arms=3.0),
    _sitter("man_103_old_heavy", _R, 1.78, _FAIR, _SHAVED, _GREY, _MOSS, arms=13.0, legs=5.0),
)
"""Twelve people to choose constants on and twelve to report on, six women and six men each.

The first twelve were solved for before the training's population had its present form:
``man_young_heavy`` is flatter for his outline than almost anybody in it, ``man_old_heavy`` deeper
than anybody. The others are subjects of that population that no model was trained on, by their
numbers: of the second half of those held out, the first (women) or second (men; or the only one) of
each age and build. Ages: young to 35, middle-aged to 58; builds by the body mass index: thin to
22.5, middling to 30.
"""

SAMPLE_PERSON = PersonSource(name="man_slim", gender=Gender.MALE, half=Half.TUNING, stature_m=1.8)

PEOPLE: Mapping[str, PersonSource] = {
    source.name: source for source in (SAMPLE_PERSON, *(sitter.source for sitter in SITTERS))
}
