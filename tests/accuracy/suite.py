"""The suite's own pictures with their truth."""

import numpy as np

from fitter.request import Click, FitRequest
from fitter.vocabulary.choices import Cues, Gender
from tests.accuracy.files import CaseFiles, light_from_document, read_case
from tests.accuracy.people import load_person
from tests.accuracy.people_table import PEOPLE
from tests.accuracy.scene import Case
from tests.accuracy.true_picture import TruePicture
from tests.accuracy.truth import true_body
from tests.one_picture import one_picture

VISIBLE = 2


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
