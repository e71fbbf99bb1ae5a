"""What derivations are made of in tests, and a derivation by its kind and its options."""

import io
import json
from dataclasses import replace
from functools import cache
from uuid import UUID

import numpy as np
from PIL import Image

from api_schemas.derivation_kinds import AnyDerivationOptions
from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivations import DerivationRequest
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.render.camera import Camera
from fitter.vocabulary.choices import Gender
from service.api.derivation_kinds import needs_of
from service.demo_data.sample import load_sample
from service.jobs.inputs import (
    IMAGE,
    OVERLAY,
    PERSON,
    REQUEST,
    RESULT,
    SEGMENTATION,
    SentPicture,
    of_other,
    own_and_others,
)
from service.submissions.submission import check_fit
from service.worker.pipeline import derive, run
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
    PipelineInput,
)
from tests.unit.service.fit_results import fit_result


def png(width: int = 80, height: int = 120, *, level: int = 90) -> bytes:
    stream = io.BytesIO()
    Image.new("RGB", (width, height), (level, level, level)).save(stream, "PNG")
    return stream.getvalue()


def person() -> FittedPerson:
    model = load_body_model(packaged_model_path("female"))
    shape = np.zeros(len(model.shape_basis))
    shape[2] = 1.0
    return FittedPerson(
        gender=Gender.FEMALE,
        model_checksum=str(model.header["checksum"]),
        body=BodyParameters(
            pose=np.zeros((len(model.part_names), 3)),
            translation=np.array([0.0, 0.0, 3.0]),
            shape=shape,
        ),
        camera=Camera(focal_length_px=150.0, centre_x=40.0, centre_y=60.0, width=80, height=120),
        light=None,
        reflectance=None,
        albedo_rgb=None,
        shape_covariance=0.1 * np.eye(len(shape)),
    )


INPUTS = {
    PERSON: person().to_bytes(),
    RESULT: fit_result(light=None, reflectance=None).model_dump_json().encode(),
    IMAGE: png(),
    SEGMENTATION: png(66, 99, level=255),
    OVERLAY: png(),
}


OTHERS = {of_other(name, 0): INPUTS[name] for name in (PERSON, RESULT)}

FITS = ("0d3c1b6e-52a4-4f0e-9e37-0a4f6c2f7d10", "a2d6a7b0-3a0b-4a7c-8f9e-5f4f0d9f5b11")
OWN = UUID("7c9e6679-7425-40de-944b-e07fc1f90ae7")

CHART_CSV = "size,chest_girth,waist_girth_navel\nS,80-90,70-80\nM,90-100,80-90\nL,100-110,90-100\n"

NEEDED = {
    "combined": {"fits": FITS[:1]},
    "size": {"chart_csv": CHART_CSV},
    "change": {"since": FITS[0]},
}
"""What kinds cannot do without."""


@cache
def sample_inputs() -> dict[str, bytes]:
    """A finished fit of the sample, by silhouette and edges, and others of the same picture.

    The first other one tells two coefficients a little otherwise, the second is of somebody else.
    """
    sample = load_sample()
    asked = json.dumps(json.loads(sample.request) | {"cues": "SE"}).encode()
    options = check_fit(request=asked, image=sample.image, mask=None, max_pixels=1_000_000).options
    output = run(
        PipelineInput(
            options=options, pictures=(SentPicture(sample.image, None),), max_pixels=1_000_000
        ),
        lambda _: None,
    )
    own = {
        PERSON: output.artifacts[PERSON],
        IMAGE: sample.image,
        REQUEST: options.model_dump_json().encode(),
    }
    fitted = FittedPerson.from_bytes(own[PERSON])
    inputs = own | {RESULT: output.result.model_dump_json().encode()}
    for index, offset in enumerate(([0.0, 0.0, 0.1, 0.1], [0.0, 6.0, -6.0, 6.0])):
        shape = fitted.body.shape.copy()
        shape[: len(offset)] += offset
        body = replace(fitted.body, shape=shape)
        other = own | {PERSON: replace(fitted, body=body).to_bytes()}
        inputs |= {of_other(name, index): content for name, content in other.items()}
    return inputs


def inputs_of(options: AnyDerivationOptions) -> dict[str, bytes]:
    """What a derivation needs of a finished fit, and no more."""
    there = sample_inputs() if options.kind == "combined" else INPUTS | OTHERS
    needs = needs_of(options)
    named = [*needs.of_fit]
    for index in range(len(needs.other_fits)):
        named += [of_other(name, index) for name in needs.of_others]
    return {name: there[name] for name in named if name in there}


def derived(
    *, files: dict[str, bytes] | None = None, **request: object
) -> DerivationOutput[DerivedFiles]:
    options = DerivationRequest.model_validate_json(json.dumps(request)).root
    stages: list[str] = []
    inputs, others = own_and_others(inputs_of(options) | (files or {}))
    output = derive(
        DerivationInput(
            options=options,
            inputs=inputs,
            others=others,
            max_pixels=1_000_000,
            fit_id=OWN,
        ),
        lambda report: stages.append(report.stage),
    )
    assert stages
    return output
