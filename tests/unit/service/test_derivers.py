"""Every kind has what derives it, and says on the wire what the fitter knows."""

import io
import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from api_schemas.derivations import (
    TEXTURE_SIZES,
    DerivationKind,
    DerivationRequest,
    DerivationResult,
    NamedPose,
)
from fitter.applications.fitted_person import FittedPerson
from fitter.applications.poses import NAMED_POSES, REST
from fitter.applications.texture import SIZES
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.camera import Camera
from fitter.parameters import BodyParameters
from fitter.request import Gender
from service.inputs import (
    CLIP,
    IMAGE,
    OF_ITS_FIT,
    OVERLAY,
    PERSON,
    RESULT,
    SEGMENTATION,
    other_person,
)
from service.worker.artifacts import MEDIA_TYPES, with_result_document
from service.worker.derivers import MODULES
from service.worker.pipeline import derive
from service.worker.pipeline_port import DerivationInput, DerivationOutput, UnusableInputError
from tests.unit.export.glb_reader import read_glb
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
    )


def with_certainty(**coefficients: float) -> bytes:
    """The same person by another picture, which tells a coefficient otherwise."""
    other = person()
    shape = other.body.shape.copy()
    for name, value in coefficients.items():
        shape[int(name.removeprefix("c"))] = value
    certain = np.diag(np.concatenate([[0.0], np.full(len(shape) - 1, 0.1)]))
    body = replace(other.body, shape=shape)
    return replace(other, body=body, shape_covariance=certain).to_bytes()


INPUTS = {
    PERSON: with_certainty(),
    other_person(0): with_certainty(c2=1.1, c3=0.2),
    other_person(1): with_certainty(c2=-2.0, c3=3.0),
    RESULT: fit_result(light=None, reflectance=None).model_dump_json().encode(),
    IMAGE: png(),
    SEGMENTATION: png(66, 99, level=255),
    OVERLAY: png(),
}


NEEDED = {"combined": {"fits": ["0d3c1b6e-52a4-4f0e-9e37-0a4f6c2f7d10"]}}
"""What kinds cannot do without."""


def derived(*, clip: bytes | None = None, **request: object) -> DerivationOutput:
    options = DerivationRequest.model_validate_json(json.dumps(request)).root
    stages: list[str] = []
    output = derive(
        DerivationInput(
            options=options,
            inputs=INPUTS | ({} if clip is None else {CLIP: clip}),
            max_pixels=10_000,
        ),
        lambda report: stages.append(report.stage),
    )
    assert stages
    return output


def test_every_kind_has_a_module_and_inputs():
    assert set(MODULES) == set(OF_ITS_FIT) == set(DerivationKind)


def test_the_named_poses_of_the_wire_are_the_fitter_s():
    assert {pose.value for pose in NamedPose} == {REST, *NAMED_POSES}


@pytest.mark.parametrize("kind", list(DerivationKind))
def test_a_derivation_s_document_lists_its_files_and_is_of_its_type(kind):
    output = derived(kind=kind, **NEEDED.get(kind, {}))
    assert {f".{name.rpartition('.')[2]}" for name in output.artifacts} <= set(MEDIA_TYPES)
    files = with_result_document(output.result, output.artifacts)
    document = DerivationResult.model_validate_json(files[RESULT]).root
    assert document.kind == kind
    assert {each.name for each in document.artifacts} == set(output.artifacts)


def test_the_same_derivation_gives_the_same_bytes():
    assert derived(kind="report").artifacts == derived(kind="report").artifacts


def test_a_caricature_says_what_was_exaggerated():
    output = derived(kind="caricature", factor=1.5)
    result = output.result.model_dump()
    assert (result["coefficient"], result["before"], result["after"]) == (2, 1.0, 1.5)
    glb = read_glb(output.artifacts["body_caricature.glb"])
    positions = glb.attribute("POSITION")
    assert positions[:, 1].min() == pytest.approx(0.0, abs=1e-6)
    assert glb.document["asset"]["extras"]["factor"] == 1.5


def test_a_named_pose_departs_where_it_is_told_to():
    standing = derived(kind="pose", pose="standing").result.model_dump()["pose"]
    turned = derived(kind="pose", pose="standing", rotations={"head": [0.0, 0.3, 0.0]})
    changed = [
        (one["part"], other["rotation"])
        for one, other in zip(standing, turned.result.model_dump()["pose"], strict=True)
        if one["rotation"] != pytest.approx(other["rotation"], abs=1e-9)
    ]
    assert changed == [("head", pytest.approx((0.0, 0.3, 0.0)))]


def test_the_combined_body_lies_between_those_of_the_fits():
    result = derived(kind="combined", **NEEDED["combined"]).result.model_dump()
    assert result["pictures"] == 2
    assert 0.9 < result["shape"][2] < 1.1
    assert 0.0 < result["shape"][3] < 0.2
    assert result["agreement"] > 0.5
    assert not result["warnings"]
    waist = next(each for each in result["measurements"] if each["name"] == "waist_girth_navel")
    assert waist["standard_error"] > 0.0


def test_pictures_of_different_people_are_combined_with_a_warning_that_names_the_fit():
    fits = [NEEDED["combined"]["fits"][0], "a2d6a7b0-3a0b-4a7c-8f9e-5f4f0d9f5b11"]
    (warning,) = derived(kind="combined", fits=fits).result.model_dump()["warnings"]
    assert warning["code"] == "different-people"
    assert fits[1] in warning["message"]


def test_a_texture_with_its_light_divided_out_needs_a_fit_with_shading():
    with pytest.raises(UnusableInputError) as caught:
        derived(kind="texture", colours="albedo")
    assert caught.value.error.field == "colours"


def test_the_sizes_of_textures_on_the_wire_are_the_fitter_s():
    assert TEXTURE_SIZES == SIZES


def test_a_clip_that_comes_along_is_what_moves_the_body_and_says_its_errors():
    with pytest.raises(UnusableInputError) as caught:
        derived(clip=b"HIERARCHY\nROOT Hips\n{\n}\n", kind="animation")
    assert caught.value.error.field == "bvh"


@pytest.mark.parametrize(
    ("request_", "field"),
    [
        ({"kind": "caricature", "factor": 99.0}, "factor"),
        ({"kind": "pose", "rotations": {"tail": [0.0, 0.0, 1.0]}}, "rotations.tail"),
        ({"kind": "pose", "rotations": {"left_shin": [3.0, 0.0, 0.0]}}, "rotations.left_shin"),
    ],
)
def test_what_cannot_be_made_is_refused_with_the_field_and_what_to_do(request_, field):
    with pytest.raises(UnusableInputError) as caught:
        derived(**request_)
    assert caught.value.error.field == field
    assert caught.value.error.remedy
