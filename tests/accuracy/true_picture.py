"""A picture whose person, camera and light are known, whoever made it, and what a fit is told."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Mask
from fitter.parameters import Light
from fitter.request import Click, FitRequest, KnownMeasurement
from fitter.vocabulary.choices import Clothing, Cues, Gender
from tests.accuracy.files import CaseFiles, Labels, encoded_mask, light_from_document, read_case
from tests.accuracy.people import load_person
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Case, Half, Series
from tests.accuracy.truth import TrueBody, true_body
from tests.one_picture import changed, one_picture

VISIBLE = 2
"""The visibility of a point that is seen, as requests write it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Told:
    """What a fit is told beyond its request: what the errors would be without that difficulty.

    ``proposed`` is told less: no points, so that the detector proposes them.

    ``mask`` the person as seen, in place of segmentation; ``focal_length`` in pixels, where the
    picture does not give it; ``measurements`` are named and given as the caller of the service may
    give them; ``clothing`` how clothes are said to lie.
    """

    mask: bool = False
    focal_length: bool = False
    measurements: tuple[str, ...] = ()
    clothing: Clothing = Clothing.AUTO
    proposed: bool = False


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class TruePicture:
    """One picture and its truth.

    Attributes
    ----------
    request
        What the service would be asked.
    body_mask, person_mask
        The body alone, and with hair and clothes.
    focal_length_px
        Of the picture as it was sent.
    light
        None where the truth does not tell it.
    joints
        (p, 3) of the body model's parts, camera frame, metres; NaN where the truth has none.
    truth
        The person's body.
    outfit
        The class of what is worn, in words; empty for underwear.
    labels
        (h, w) the :class:`~tests.accuracy.scene.Label` of each pixel; None where they are not
        known.
    """

    name: str
    person: str
    series: Series
    half: Half
    request: FitRequest
    body_mask: Mask
    person_mask: Mask
    focal_length_px: float
    light: Light | None
    joints: Float[np.ndarray, "p 3"]
    truth: TrueBody
    outfit: str = ""
    labels: Labels | None = None


def told_request(picture: TruePicture, told: Told) -> FitRequest:
    """The picture's request with what is told beside."""
    request = changed(picture.request, clothing=told.clothing)
    if told.proposed:
        request = changed(request, clicks={}, complete_clicks=True)
    if told.mask:
        request = changed(request, mask=encoded_mask(picture.person_mask))
    if told.focal_length:
        request = changed(request, focal_length_px=picture.focal_length_px, focal_length_35mm=None)
    if told.measurements:
        true = picture.truth.measurements
        known = {name: KnownMeasurement(value=true[name]) for name in told.measurements}
        request = changed(request, measurements=known)
    return request


def case_picture(case: Case) -> TruePicture:
    """A case's picture and truth."""
    files, source = read_case(case), PEOPLE[case.person]
    return TruePicture(
        name=case.name,
        person=case.person,
        series=case.series,
        half=source.half,
        request=fit_request(files, Cues.SES),
        body_mask=files.body_mask,
        person_mask=files.person_mask,
        focal_length_px=files.scene["focal_length_px"],
        light=light_from_document(files.scene["light"]),
        joints=np.array(files.scene["joints_m"]),
        truth=true_body(load_person(source)),
        outfit="" if case.outfit is None else case.outfit.name,
        labels=files.labels,
    )


def fit_request(files: CaseFiles, cues: Cues) -> FitRequest:
    """The request a case's file holds."""
    options = files.request
    return one_picture(
        image=files.image,
        clicks={
            name: Click(x=point["x"], y=point["y"], occluded=point["visibility"] < VISIBLE)
            for name, point in options["points"].items()
        },
        gender=Gender(options["gender"]),
        height_m=options["height_m"],
        focal_length_px=options.get("focal_length_px"),
        cues=cues,
        force=True,
    )
