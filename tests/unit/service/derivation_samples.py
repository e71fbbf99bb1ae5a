"""What derivations are made of in tests, and a derivation by its kind and its options."""

import io
import json

import numpy as np
from PIL import Image

from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivations import DerivationRequest
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.render.camera import Camera
from fitter.vocabulary.choices import Gender
from service.api.derivation_kinds import needs_of
from service.jobs.inputs import (
    IMAGE,
    OVERLAY,
    PERSON,
    RESULT,
    SEGMENTATION,
    of_view,
)
from service.worker.pipeline import derive
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
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
    RESULT: fit_result().model_dump_json().encode(),
    of_view(0, IMAGE): png(),
    of_view(0, SEGMENTATION): png(66, 99, level=255),
    of_view(0, OVERLAY): png(),
}


CHART_CSV = "size,chest_girth,waist_girth_navel\nS,80-90,70-80\nM,90-100,80-90\nL,100-110,90-100\n"

NEEDED = {
    "size": {"chart_csv": CHART_CSV},
}
"""What kinds cannot do without."""


def derived(
    *, files: dict[str, bytes] | None = None, **request: object
) -> DerivationOutput[DerivedFiles]:
    options = DerivationRequest.model_validate_json(json.dumps(request)).root
    stages: list[str] = []
    # What a derivation needs of a finished fit, and no more.
    inputs = {name: INPUTS[name] for name in needs_of(options).of_fit}
    output = derive(
        DerivationInput(options=options, inputs=inputs | (files or {}), max_pixels=1_000_000),
        lambda report: stages.append(report.stage),
    )
    assert stages
    return output
