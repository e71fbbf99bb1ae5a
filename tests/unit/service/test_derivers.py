"""What derives a kind makes do with what the kind needs, and says what the fitter knows."""

import csv
import io
import json
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from uuid import UUID

import numpy as np
import pytest
from PIL import Image

from api_schemas.derivation_kinds import AnyDerivationOptions, DerivationKind
from api_schemas.derivation_kinds.base import DerivedFiles
from api_schemas.derivation_kinds.texture import LEAST_OWN_TEXTURE, TEXTURE_SIZES
from api_schemas.derivations import DerivationRequest, DerivationResult
from api_schemas.named_poses import NamedPose
from fitter.applications.own_texture import LEAST_SIDE
from fitter.applications.poses import NAMED_POSES, REST
from fitter.applications.texture import SIZES
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.fits.prepared_model import prepared_model
from fitter.measurement.anthropometry import measure
from fitter.parameters import BodyParameters, Light, LightKind, Reflectance
from fitter.person.fitted_person import FittedPerson
from fitter.render.camera import Camera
from fitter.request import FitRequest, Gender, OptimizerKind
from service.api.derivation_kinds import needs_of
from service.demo_data.sample import load_sample
from service.jobs.inputs import (
    CHART,
    CLIP,
    IMAGE,
    OVERLAY,
    PERSON,
    REQUEST,
    RESULT,
    SEGMENTATION,
    TEXTURE,
    of_other,
    own_and_others,
)
from service.submissions.submission import check_submission
from service.worker.artifacts import MEDIA_TYPES, with_result_document
from service.worker.derived import combined
from service.worker.pipeline import derive, run
from service.worker.pipeline_port import (
    DerivationInput,
    DerivationOutput,
    PipelineInput,
    UnusableInputError,
)
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
    options = check_submission(
        request=asked, image=sample.image, mask=None, max_pixels=1_000_000
    ).options
    output = run(
        PipelineInput(options=options, image=sample.image, mask=None, max_pixels=1_000_000),
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


@pytest.mark.parametrize(("duration_s", "frames"), [(0.001, 1), (0.2, 6)])
def test_a_walk_is_as_long_as_it_is_asked_to_be(duration_s: float, frames: int):
    result = derived(kind="animation", start_s=100.0, duration_s=duration_s).result.model_dump()
    assert (result["frames"], result["warnings"]) == (frames, ())


def shape_of(inputs: dict[str, bytes], name: str = PERSON) -> np.ndarray:
    return FittedPerson.from_bytes(inputs[name]).body.shape


def test_the_combined_body_is_one_body_near_those_of_the_fits():
    inputs = sample_inputs()
    result = derived(kind="combined", **NEEDED["combined"]).result.model_dump()
    own, other = shape_of(inputs), shape_of(inputs, of_other(PERSON, 0))
    assert result["pictures"] == 2
    # The same picture twice: it is searched again, with what outlines say counted for more.
    assert np.linalg.norm(np.array(result["shape"]) - 0.5 * (own + other)) < 0.6 * np.sqrt(len(own))
    assert result["agreement"] > 0.5
    assert not result["warnings"]
    waist = next(each for each in result["measurements"] if each["name"] == "waist_girth_navel")
    assert waist["standard_error"] > 0.0


def test_a_combined_body_stands_in_each_picture_in_its_pose():
    output = derived(kind="combined", **NEEDED["combined"])
    result = output.result.model_dump()
    assert [each["number"] for each in result["bodies"]] == [1, 2]
    assert [str(each["fit_id"]) for each in result["bodies"]] == [str(OWN), FITS[0]]
    for each in result["bodies"]:
        assert each["body"]["shape"] == result["shape"]
        assert each["silhouette_overlap"] > 0.85
        glb = read_glb(output.artifacts[f"body_posed_{each['number']}.glb"])
        depth = -glb.attribute("POSITION")[:, 2].mean()
        assert depth == pytest.approx(each["body"]["translation_m"][2], abs=0.2)
        with Image.open(io.BytesIO(output.artifacts[f"overlay_{each['number']}.png"])) as overlay:
            camera = each["image_camera"]
            assert overlay.size == (camera["width"], camera["height"])


def test_pictures_of_different_people_are_combined_with_a_warning_that_names_the_fit():
    (warning,) = derived(kind="combined", fits=FITS).result.model_dump()["warnings"]
    assert warning["code"] == "different-people"
    assert FITS[1] in warning["message"]
    assert "in less than 0.01 % of cases" in warning["message"]


def test_fits_that_were_told_other_heights_are_not_combined():
    taller = json.loads(sample_inputs()[REQUEST]) | {"height_m": 1.9}
    told = {of_other(REQUEST, 0): json.dumps(taller).encode()}
    with pytest.raises(UnusableInputError) as caught:
        derived(files=told, kind="combined", fits=FITS[:1])
    assert caught.value.error.field == "fits.0"


def test_pictures_are_searched_by_gauss_newton_however_their_fits_were(monkeypatch):
    class EnoughError(Exception):
        pass

    asked: list[FitRequest] = []

    def noted(_: object, requests: Sequence[FitRequest], **__: object) -> None:
        asked.extend(requests)
        raise EnoughError

    monkeypatch.setattr(combined, "joint_fit", noted)
    simplex = json.loads(sample_inputs()[REQUEST]) | {"optimizer": "simplex"}
    told = json.dumps(simplex).encode()
    with pytest.raises(EnoughError):
        derived(files={REQUEST: told, of_other(REQUEST, 0): told}, kind="combined", fits=FITS[:1])
    assert [each.optimizer for each in asked] == [OptimizerKind.GAUSS_NEWTON] * 2


def test_a_texture_with_its_light_divided_out_needs_a_fit_with_shading():
    with pytest.raises(UnusableInputError) as caught:
        derived(kind="texture", colours="albedo")
    assert caught.value.error.field == "colours"


def lit_person() -> bytes:
    vertices = len(load_body_model(packaged_model_path("female")).mean_vertices)
    return replace(
        person(),
        light=Light(kind=LightKind.POINT, azimuth=0.4, elevation=0.3, distance=2.0),
        reflectance=Reflectance(
            albedo=np.full(vertices, 0.5),
            specularity=np.zeros(vertices),
            ambient=0.1,
            specular_exponent=10.0,
        ),
    ).to_bytes()


@pytest.mark.parametrize(
    ("fitted", "extensions"),
    [(lambda: person().to_bytes(), []), (lit_person, ["KHR_lights_punctual"])],
    ids=["without light", "with light"],
)
def test_a_texture_of_one_s_own_is_albedo_in_the_light_of_the_fit(fitted, extensions):
    painted = png(96, 96, level=131)
    output = derived(
        files={TEXTURE: painted, PERSON: fitted()}, kind="texture", colours="own", size=512
    )
    assert set(output.artifacts) == {"body_textured.glb", "texture.png", "atlas.png"}
    result = output.result.model_dump()
    assert (result["colours"], result["size"], result["scale"]) == ("own", 96, 1.0)
    assert (result["seen_share"], result["mirrored_share"]) == (0.0, 0.0)
    texture = np.asarray(Image.open(io.BytesIO(output.artifacts["texture.png"])))
    assert texture.shape == (96, 96, 3)
    assert set(np.unique(texture)) == {0, 131}
    assert Image.open(io.BytesIO(output.artifacts["atlas.png"])).mode == "RGBA"
    glb = read_glb(output.artifacts["body_textured.glb"])
    assert glb.document.get("extensionsUsed", []) == extensions
    view = glb.document["bufferViews"][glb.document["images"][0]["bufferView"]]
    start = view["byteOffset"]
    stored = glb.binary[start : start + view["byteLength"]]
    assert stored == output.artifacts["texture.png"]


@pytest.mark.parametrize("content", [png(96, 96)[:-40], png(96, 64), b"\x89PNG\r\n\x1a\n"])
def test_a_texture_that_cannot_be_laid_on_the_body_is_refused_with_the_part(content):
    with pytest.raises(UnusableInputError) as caught:
        derived(files={TEXTURE: content}, kind="texture", colours="own")
    assert caught.value.error.field == "texture"
    assert caught.value.error.remedy


def test_the_sizes_of_textures_on_the_wire_are_the_fitter_s():
    assert TEXTURE_SIZES == SIZES
    assert LEAST_OWN_TEXTURE == LEAST_SIDE


def test_a_clip_that_comes_along_is_what_moves_the_body_and_says_its_errors():
    with pytest.raises(UnusableInputError) as caught:
        derived(files={CLIP: b"HIERARCHY\nROOT Hips\n{\n}\n"}, kind="animation")
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


def test_a_size_follows_from_a_chart_in_the_request_or_beside_it():
    inline = derived(kind="size", chart_csv=CHART_CSV).result
    beside = derived(kind="size", files={CHART: CHART_CSV.encode()}).result
    sizes = [
        {
            "label": label,
            "measurements": {
                "chest_girth": {"low": chest, "high": chest + 10},
                "waist_girth_navel": {"low": waist, "high": waist + 10},
            },
        }
        for label, chest, waist in (("S", 80, 70), ("M", 90, 80), ("L", 100, 90))
    ]
    spelled_out = derived(kind="size", chart={"sizes": sizes}).result
    assert inline == beside == spelled_out
    result = inline.model_dump()
    chances = [each["probability"] for each in result["sizes"]]
    assert sum(chances) + result["none_fits"] == pytest.approx(1.0)
    assert [each["name"] for each in result["arguments"]] == ["chest_girth", "waist_girth_navel"]
    assert result["recommended"] == result["sizes"][int(np.argmax(chances))]["label"]


def test_the_table_of_sizes_says_what_the_result_does():
    output = derived(kind="size", chart_csv=CHART_CSV)
    table = list(csv.DictReader(io.StringIO(output.artifacts["sizes.csv"].decode())))
    sizes = output.result.model_dump()["sizes"]
    assert [each["label"] for each in table] == ["S", "M", "L"]
    assert [float(each["probability"]) for each in table] == [each["probability"] for each in sizes]


def test_ease_and_gaps_of_a_chart_reach_the_answer():
    gaps = CHART_CSV.replace("80-90,70-80", "80-89,70-79")
    result = derived(kind="size", chart_csv=gaps, ease={"chest_girth": 12}).result.model_dump()
    assert {each["code"] for each in result["warnings"]} == {"chart-gap"}
    assert result["arguments"][0]["ease"] == pytest.approx(12.0)
    plain = derived(kind="size", chart_csv=gaps).result.model_dump()
    assert result["sizes"] != plain["sizes"]


def test_standard_errors_of_what_follows_are_those_of_the_measurements():
    result = derived(kind="size", chart_csv=CHART_CSV).result.model_dump()
    prepared = prepared_model(Gender.FEMALE)
    someone = person()
    measured = measure(
        prepared.measuring, someone.body.shape, shape_covariance=someone.shape_covariance
    )
    found = {each.name: each for each in measured}
    for each in result["arguments"]:
        assert each["value"] == pytest.approx(found[each["name"]].value)
        assert each["standard_error"] == pytest.approx(found[each["name"]].standard_error, rel=1e-3)


def test_body_fat_says_why_it_is_withheld_for_the_young():
    adult, child = (
        derived(kind="body_composition", age_years=age).result.model_dump() for age in (30, 12)
    )
    assert [each["name"] for each in adult["estimates"]] == ["us_navy", "cun_bae"]
    for each in adult["estimates"]:
        assert 5.0 < each["percent"] < 60.0
        assert each["standard_error"] > each["regression_error"]
    assert [each["percent"] for each in child["estimates"]] == [None, None]
    assert all("years, not of 12" in each["withheld"][0] for each in child["estimates"])


def changed_person(**shifts: float) -> dict[str, bytes]:
    """The other fit of a comparison, with some coefficients shifted."""
    someone = person()
    shape = someone.body.shape.copy()
    for index, shift in shifts.items():
        shape[int(index.removeprefix("b"))] += shift
    other = replace(someone, body=replace(someone.body, shape=shape))
    return {of_other(PERSON, 0): other.to_bytes()}


def test_the_same_fit_twice_has_changed_in_nothing():
    result = derived(kind="change", since=FITS[0]).result.model_dump()
    assert {each["difference"] for each in result["changes"]} == {0.0}
    assert not any(each["is_change"] for each in result["changes"])
    assert result["warnings"] == ()


def test_a_large_difference_is_a_change_and_a_small_one_is_none():
    small, large = (
        derived(kind="change", since=FITS[0], files=changed_person(b1=shift)).result.model_dump()
        for shift in (-0.05, -5.0)
    )
    assert not any(each["is_change"] for each in small["changes"])
    called = {each["name"] for each in large["changes"] if each["is_change"]}
    assert "weight" in called
    for each in large["changes"]:
        assert each["difference"] == pytest.approx(each["after"] - each["before"])


def test_fewer_measurements_are_compared_by_a_smaller_least_difference():
    names = ["waist_girth_navel", "weight"]
    everything = derived(kind="change", since=FITS[0]).result.model_dump()["changes"]
    chosen = derived(kind="change", since=FITS[0], measurements=names).result.model_dump()
    assert [each["name"] for each in chosen["changes"]] == names
    least = {each["name"]: each["least"] for each in everything}
    for each in chosen["changes"]:
        assert each["least"] < least[each["name"]]


def test_a_change_of_height_is_remarked_on():
    (warning,) = derived(
        kind="change", since=FITS[0], files=changed_person(b0=1.0)
    ).result.model_dump()["warnings"]
    assert warning["code"] == "heights-differ"


@pytest.mark.parametrize("kind", ["size", "body_composition", "change"])
def test_nothing_follows_from_measurements_that_are_withheld(kind):
    withheld = fit_result(light=None, reflectance=None, measurements=())
    files = {RESULT: withheld.model_dump_json().encode()}
    with pytest.raises(UnusableInputError) as caught:
        derived(kind=kind, files=files, **NEEDED.get(kind, {}))
    assert (caught.value.error.code, caught.value.error.field) == ("fits-unusable", "kind")


def test_a_fit_of_another_gender_is_nobody_s_earlier_one():
    model = load_body_model(packaged_model_path("male"))
    man = replace(person(), gender=Gender.MALE, model_checksum=str(model.header["checksum"]))
    with pytest.raises(UnusableInputError) as caught:
        derived(kind="change", since=FITS[0], files={of_other(PERSON, 0): man.to_bytes()})
    assert (caught.value.error.code, caught.value.error.field) == ("fits-unusable", "since")
