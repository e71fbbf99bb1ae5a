"""A finished fit without a fit, and a product of it by its kind and its options."""

import io
import json
from dataclasses import replace
from typing import Any

import numpy as np
from PIL import Image
from pydantic import TypeAdapter

from api_schemas.products import AnyProductResult
from api_schemas.products.base import ProductResult
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.render.camera import Camera
from fitter.vocabulary.choices import Gender
from service.compute.pipeline import product_task
from service.compute.products.finished_fit import Made
from service.compute.tasks import OPTIONS, ChildSetup
from service.jobs.inputs import BODY, IMAGE, OVERLAY, PERSON, RESULT, SEGMENTATION, of_view
from tests.unit.service.fit_results import fit_result


def png(width: int = 80, height: int = 120, *, level: int = 90) -> bytes:
    stream = io.BytesIO()
    Image.new("RGB", (width, height), (level, level, level)).save(stream, "PNG")
    return stream.getvalue()


def person(**changes: Any) -> FittedPerson:
    model = load_body_model(packaged_model_path("female"))
    shape = np.zeros(len(model.shape_basis))
    shape[2] = 1.0
    someone = FittedPerson(
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
    return replace(someone, **changes)


FILES = {
    PERSON: person().to_bytes(),
    RESULT: fit_result().model_dump_json().encode(),
    BODY: png(300, 100),
    of_view(0, IMAGE): png(),
    of_view(0, SEGMENTATION): png(66, 99, level=255),
    of_view(0, OVERLAY): png(),
}


RESULTS = TypeAdapter(AnyProductResult)


def made(*, files: dict[str, bytes] | None = None, **request: object) -> Made[ProductResult]:
    stages: list[str] = []
    parts = product_task(
        ChildSetup(name="job", max_pixels=1_000_000),
        {**FILES, **(files or {}), OPTIONS: json.dumps(request).encode()},
        lambda report: stages.append(report.stage),
    )
    result = RESULTS.validate_json(parts[RESULT])
    assert set(stages) == {result.kind}
    return Made(result=result, files={name: parts[name] for name in parts if name != RESULT})
