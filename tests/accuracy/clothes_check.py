"""What the checks say of clothes, beside what people wear: loose, close or underwear."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from fitter.capture.checking import check_capture
from fitter.detection.detector import installed_detector
from fitter.fits.capture_check import CaptureQuestion, capture_of
from fitter.observation.decoding import decode_picture
from fitter.vocabulary.choices import BodyRegion, Covering
from fitter.vocabulary.remarks import Code
from tests.accuracy.cases import CASES, PEOPLE
from tests.accuracy.dressed import dressed_names, garments
from tests.accuracy.foreign import foreign_half, foreign_names
from tests.accuracy.painted_clothes import PREFIX, painted_names
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Case, Half, Series

MAX_PIXELS = 50_000_000
SAID = ("loose", "close", "bare", "not said")

CLOSE = "close-fitting"
"""What the dressed set calls garments that do not stand off the body."""

_TRUNK_AND_LEGS = (BodyRegion.UPPER, BodyRegion.LOWER, BodyRegion.LEGS)
_UNCHECKED = SAID[-1]


@dataclass(frozen=True, slots=True, kw_only=True)
class SaidOfClothes:
    """What a check says of the clothes in a picture; ``regions`` are in words."""

    group: str
    name: str
    said: str
    regions: str


def clothed_pictures(half: Half) -> list[tuple[str, str]]:
    """Names of pictures after what is worn in them; dressed foreigners belong to both halves."""
    own = [case for case in CASES.values() if PEOPLE[case.person].half is half]
    loose = [name for name in dressed_names() if CLOSE not in garments(name)]
    clothed = [each for each in own if each.series is Series.CLOTHED]
    groups = {
        "loose, own": [each.name for each in clothed if _wears_loose(each)],
        "close, own": [each.name for each in clothed if not _wears_loose(each)],
        "loose, dressed set": loose,
        "close, dressed set": [name for name in dressed_names() if name not in loose],
        "close, painted set": [
            name for name in painted_names() if foreign_half(name.removeprefix(PREFIX)) is half
        ],
        "underwear, own": [each.name for each in own if each.series is Series.PEOPLE],
        "underwear, foreign": foreign_names(half),
    }
    return [(group, name) for group, names in groups.items() for name in names]


def _wears_loose(case: Case) -> bool:
    return case.outfit is not None and CLOSE not in case.outfit.name


def clothes_said(asked: tuple[str, str]) -> SaidOfClothes:
    """Of a picture in a group, both by their names."""
    group, name = asked
    picture = picture_of(name)
    question = CaptureQuestion(
        gender=picture.request.person.gender, height_m=picture.request.person.height_m
    )
    image = decode_picture(picture.request.views[0].image, field="image", max_pixels=MAX_PIXELS)
    capture = capture_of(image, question, detector=installed_detector())
    checked = check_capture(capture)
    clothing = capture.clothing or ()
    kinds = {each.kind for each in clothing if each.region in _TRUNK_AND_LEGS}
    if Code.CLOTHES_LOOSE in {each.code for each in checked.findings}:
        said = "loose"
    elif Code.CLOTHES_LOOSE in {each.code for each in checked.unchecked}:
        said = _UNCHECKED
    else:
        said = "close" if Covering.CLOSE in kinds else "bare"
    told = (f"{each.region} {each.kind} {each.probability:.2f}" for each in clothing)
    return SaidOfClothes(group=group, name=name, said=said, regions=", ".join(told))


def clothes_lines(said: Sequence[SaidOfClothes]) -> list[str]:
    """What is said, counted by group; then each picture of which something else is true."""
    lines = [f"{'clothes':24s}" + "".join(f"{word:>10s}" for word in SAID)]
    for group in dict.fromkeys(each.group for each in said):
        counts = Counter(each.said for each in said if each.group == group)
        lines.append(f"{group:24s}" + "".join(f"{counts[word]:10d}" for word in SAID))
    return lines + [
        f"{each.group}: {each.name} {each.said}: {each.regions}"
        for each in said
        if (each.said == "loose") is not each.group.startswith("loose")
    ]
