"""What hides skin or looks like it: gloves, stockings, masks, beards, open vests, dark skin, cloth
of the skin's colour.

Painted on the suite's own people, in underwear and in clothes. Light and shade stay as they were
rendered: a pixel keeps its light over what its surface reflected, and gets another reflectance.
"""

import io
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import cv2
import numpy as np
from jaxtyping import Float, Shaped
from PIL import Image as PillowImage

from fitter.arrays import Mask
from fitter.fits.pipeline import fit
from fitter.observation.pixels import display_from_linear, linear_from_display, luminance_of
from fitter.segmentation.skin_colour import nearest_of
from fitter.vocabulary.choices import BodyRegion, Covering, Cues
from fitter.vocabulary.remarks import Severity
from tests.accuracy.cases import CASES
from tests.accuracy.clicks import rendering
from tests.accuracy.landmark_points import packaged_model, rest_landmarks
from tests.accuracy.people import load_person, rig_of_people
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.runs import picture_of
from tests.accuracy.scene import Case, Label, Look, Rgb, Series
from tests.accuracy.staging import stage
from tests.accuracy.table import MEASUREMENTS
from tests.accuracy.true_picture import TruePicture
from tests.one_picture import changed

AS_THEY_ARE: Final = "as they are"

DARK_SKIN: Final[Rgb] = (0.085, 0.045, 0.03)
CLOTHS: Final[Sequence[Rgb]] = (
    (0.025, 0.025, 0.028),
    (0.6, 0.6, 0.58),
    (0.33, 0.47, 0.56),
    (0.12, 0.03, 0.05),
)
"""Black, white, a surgeon's blue, wine red: one for each person, in turn."""

OPENING_M: Final = 0.055
"""Half the breadth that an open vest shows of the chest."""

_EDGE_PX = 0.7
_BARE_KINDS = ("chest", "spine", "pelvis", "thigh")
"""Parts that underwear may hide."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Sight:
    """A picture and what each of its pixels shows.

    Attributes
    ----------
    linear
        (h, w, 3) linear light.
    person
        (h, w) the person with hair and clothes.
    kinds
        (h, w) the part of the body, without its side, that a pixel shows or is nearest to.
    rest
        (h, w, 3) where that place of the skin is on the person at rest, body frame, metres.
    skin
        (h, w) bare skin; of people in underwear hair too.
    cloth
        (h, w) upper and lower garment, or underwear.
    """

    case: Case
    linear: Float[np.ndarray, "h w 3"]
    person: Mask
    kinds: Shaped[np.ndarray, "h w"]
    rest: Float[np.ndarray, "h w 3"]
    skin: Mask
    cloth: Mask
    colour: Rgb

    def repainted(self, on: Mask, reflected: Rgb, colour: Rgb) -> Float[np.ndarray, "h w 3"]:
        """With another reflectance where a surface reflected so much."""
        light = luminance_of(self.linear) / float(luminance_of(np.array(reflected)))
        share = cv2.GaussianBlur(on.astype(np.float64), (0, 0), _EDGE_PX)
        person = cv2.GaussianBlur(self.person.astype(np.float64), (0, 0), _EDGE_PX)
        # To the rim of the person, whose pixels are partly wall.
        share = np.where(self.person, share / np.maximum(person, 1e-6), share)[..., None]
        return self.linear + share * (light[..., None] * np.array(colour) - self.linear)


@dataclass(frozen=True, slots=True, kw_only=True)
class Covered:
    """A picture by name, what is painted on it, and the number of its person."""

    picture: str
    kind: str
    number: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CoveredFit:
    """What came of it.

    Attributes
    ----------
    errors, standard_errors
        Measured minus true by measurement, centimetres and kilograms, and what the fit states.
    worn
        How each region in sight was taken.
    findings
        Codes of what harms or blocks.
    """

    asked: Covered
    dressed: bool
    errors: Mapping[str, float]
    standard_errors: Mapping[str, float]
    worn: Mapping[BodyRegion, Covering]
    findings: tuple[str, ...]


Paint = Callable[[Sight], Float[np.ndarray, "h w 3"]]


def _look(sight: Sight) -> Look:
    return sight.case.look


def _on_skin(sight: Sight, *kinds: str) -> Mask:
    return sight.skin & np.isin(sight.kinds, kinds)


def _gloves(sight: Sight) -> Float[np.ndarray, "h w 3"]:
    return sight.repainted(_on_skin(sight, "hand"), _look(sight).skin, sight.colour)


def _stockings(sight: Sight) -> Float[np.ndarray, "h w 3"]:
    """Opaque, to the shorts or the briefs."""
    return sight.repainted(
        _on_skin(sight, "thigh", "shin", "foot"), _look(sight).skin, sight.colour
    )


def _mask(sight: Sight) -> Float[np.ndarray, "h w 3"]:
    """From the middle of the nose to below the chin, and to the ears."""
    marks = rest_landmarks(load_person(PEOPLE[sight.case.person]))
    bridge = 0.5 * (marks["nose"] + 0.5 * (marks["left_eye"] + marks["right_eye"]))[1]
    chin, ear = marks["chin"], marks["left_ear"]
    on = (sight.rest[..., 1] < bridge) & (sight.rest[..., 1] > chin[1] - 0.015)
    on &= sight.rest[..., 2] > ear[2] + 0.01
    return sight.repainted(on & _on_skin(sight, "head", "neck"), _look(sight).skin, sight.colour)


def _beard(sight: Sight) -> Float[np.ndarray, "h w 3"]:
    """Full, in the hair's colour, from under the nose to under the chin."""
    marks = rest_landmarks(load_person(PEOPLE[sight.case.person]))
    chin, nose, ear = marks["chin"], marks["nose"], marks["left_ear"]
    on = (sight.rest[..., 1] < nose[1] - 0.012) & (sight.rest[..., 1] > chin[1] - 0.03)
    on &= sight.rest[..., 2] > ear[2] + 0.005
    look = _look(sight)
    return sight.repainted(on & _on_skin(sight, "head", "neck"), look.skin, look.hair_colour)


def _vest(sight: Sight) -> Float[np.ndarray, "h w 3"]:
    """As close as paint, over a bare midriff, with leggings."""
    aside = np.abs(sight.rest[..., 0]) > OPENING_M
    vest = (sight.kinds == "chest") & aside & sight.person
    legs = _on_skin(sight, "thigh", "shin")
    legs |= (sight.kinds == "pelvis") & _on_skin(sight, "pelvis")
    look = _look(sight)
    on_skin = sight.repainted((vest & sight.skin) | legs, look.skin, sight.colour)
    on_cloth = replace(sight, linear=on_skin)
    return on_cloth.repainted(vest & sight.cloth, look.clothes_colour, sight.colour)


def _dark_skin(sight: Sight) -> Float[np.ndarray, "h w 3"]:
    return sight.repainted(sight.skin, _look(sight).skin, DARK_SKIN)


def _like_skin(sight: Sight) -> Float[np.ndarray, "h w 3"]:
    """Whatever is worn but shoes; what is woven into it stays as light and shade."""
    return sight.repainted(sight.cloth, _worn_colour(sight.case), _look(sight).skin)


ON_ANYBODY: Final[Mapping[str, Paint]] = {
    AS_THEY_ARE: lambda sight: sight.linear,
    "gloves": _gloves,
    "face mask": _mask,
    "mask and gloves": lambda sight: _mask(replace(sight, linear=_gloves(sight))),
    "beard": _beard,
    "dark skin": _dark_skin,
    "cloth of the skin's colour": _like_skin,
}
IN_UNDERWEAR: Final[Mapping[str, Paint]] = {
    **ON_ANYBODY,
    "stockings": _stockings,
    "open vest, leggings": _vest,
}


def asked_covers(underwear: Sequence[str], clothed: Sequence[str]) -> list[Covered]:
    """Every picture with everything that suits it."""
    return [
        Covered(picture=name, kind=kind, number=number)
        for names, kinds in ((underwear, IN_UNDERWEAR), (clothed, ON_ANYBODY))
        for kind in kinds
        for number, name in enumerate(names)
    ]


def covered_fit(asked: Covered) -> CoveredFit:
    """Fit a painted picture with shading, nothing said of clothes."""
    picture = covered_picture(asked)
    result = fit(picture.request)
    found = {each.name: each for each in result.measurements}
    truth = picture.truth.measurements
    return CoveredFit(
        asked=asked,
        dressed=picture.series is Series.CLOTHED,
        errors={key: found[key].value - truth[key] for _, key, _ in MEASUREMENTS},
        standard_errors={
            key: error
            for _, key, _ in MEASUREMENTS
            if (error := found[key].standard_error) is not None
        },
        worn={each.region: each.kind for each in result.views[0].found.clothing},
        findings=tuple(
            each.code
            for each in result.found.findings
            if each.severity in (Severity.HARMS, Severity.BLOCKS)
        ),
    )


def covered_picture(asked: Covered) -> TruePicture:
    """The picture with what is painted on it; a painted file has no EXIF."""
    picture = picture_of(asked.picture)
    linear = IN_UNDERWEAR[asked.kind](sight_of(picture, CLOTHS[asked.number % len(CLOTHS)]))
    values = np.rint(255.0 * display_from_linear(np.clip(linear, 0.0, 1.0))).astype(np.uint8)
    file = io.BytesIO()
    PillowImage.fromarray(values).save(file, "PNG")
    request = changed(
        picture.request,
        image=file.getvalue(),
        cues=Cues.SES,
        focal_length_px=picture.focal_length_px,
        focal_length_35mm=None,
    )
    return replace(picture, request=request)


def sight_of(picture: TruePicture, colour: Rgb) -> Sight:
    """What the pixels of one of the suite's own pictures show."""
    case = CASES[picture.name]
    image = PillowImage.open(io.BytesIO(picture.request.views[0].image)).convert("RGB")
    linear = linear_from_display(np.asarray(image).astype(np.float64) / 255.0)
    staged = stage(load_person(PEOPLE[case.person]), case)
    surface = rig_of_people().surface
    faces = rendering(staged).face_ids
    nearest = faces.ravel()[nearest_of(faces >= 0)]
    model = packaged_model(picture.request.person.gender)
    names = np.array([name.rpartition("_")[2] for name in model.part_names])
    at_rest = surface.body(staged.person.source_vertices)[surface.triangles].mean(axis=1)
    person = picture.person_mask
    kinds = names[model.part_of_triangle[nearest]]
    if picture.labels is None:
        cloth = person & np.isin(kinds, _BARE_KINDS) & _nearer_to_cloth(linear, case.look)
        skin = person & ~cloth
    else:
        cloth = np.isin(picture.labels, [Label.UPPER, Label.LOWER])
        skin = picture.labels == Label.SKIN
    return Sight(
        case=case,
        linear=linear,
        person=person,
        kinds=kinds,
        rest=at_rest[nearest],
        skin=skin,
        cloth=cloth,
        colour=colour,
    )


def _nearer_to_cloth(linear: Float[np.ndarray, "h w 3"], look: Look) -> Mask:
    """By the logarithms of red and blue over green, which light and shade hardly change."""
    smooth = cv2.GaussianBlur(linear, (0, 0), 1.0)
    here, skin, cloth = (
        _chroma(each) for each in (smooth, np.array(look.skin), np.array(look.clothes_colour))
    )
    return np.linalg.norm(here - cloth, axis=-1) < np.linalg.norm(here - skin, axis=-1)


def _chroma(colours: Float[np.ndarray, "... 3"]) -> Float[np.ndarray, "... 2"]:
    logs = np.log(np.maximum(colours, 1e-4))
    return np.stack([logs[..., 0] - logs[..., 1], logs[..., 2] - logs[..., 1]], axis=-1)


def _worn_colour(case: Case) -> Rgb:
    """About what clothes reflect: of several and of patterns the mean."""
    if case.outfit is None:
        return case.look.clothes_colour
    worn = [each for each in (case.outfit.top, case.outfit.bottom, case.outfit.jacket) if each]
    red, green, blue = np.mean([each.cloth.colour for each in worn], axis=0)
    return (float(red), float(green), float(blue))
