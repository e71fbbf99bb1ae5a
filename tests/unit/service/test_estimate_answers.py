"""The estimator's real answers, with the measurements a request knows."""

import io
from pathlib import Path

import pytest
from PIL import Image, ImageChops, ImageStat
from pydantic import BaseModel

from api_schemas.fit import FitRequest
from api_schemas.person import UncertainMeasurement
from api_schemas.picture import Limb
from api_schemas.points import Point, PointSource
from api_schemas.questions import (
    BodyEstimate,
    BodyRequest,
    ImageSize,
    InitialPose,
    InitialPoseRequest,
    PointsProposal,
    PointsRequest,
)
from fitter.vocabulary.choices import Facing, Gender, ViewKind
from fitter.vocabulary.outcomes import SeenFrom
from fitter.vocabulary.remarks import Severity
from service.compute.answers import TASKS
from service.compute.questions import (
    ANSWER,
    BODY,
    FILE,
    INITIAL_POSE,
    JPEG,
    POINTS,
    QUESTION,
    BodyTask,
)
from service.compute.tasks import ChildSetup, Parts, ProblemError, UnusableInputError
from service.demo_data.sample import load_sample
from tests.heif_files import SAMPLE_LYING, coded, phone_picture


def asked(
    task: str, question: BaseModel | None, file: bytes = b"", *, detector: Path | None = None
) -> Parts:
    setup = ChildSetup(name="estimator", max_pixels=1_000_000, detector=detector)
    text = b"" if question is None else question.model_dump_json().encode()
    return TASKS[task](setup, {QUESTION: text, FILE: file}, lambda _: None)


def points(
    question: PointsRequest, image: bytes, *, detector: Path | None = None
) -> tuple[PointsProposal, bytes]:
    """The proposal, and the mask's PNG file."""
    parts = asked(POINTS, question, image, detector=detector)
    return PointsProposal.model_validate_json(parts[ANSWER]), parts[FILE]


def jpeg(image: bytes) -> bytes:
    return asked(JPEG, None, image)[FILE]


SAMPLE = FitRequest.model_validate_json(load_sample().request)


def answer(**known: object):
    request = BodyRequest.model_validate({"gender": Gender.FEMALE} | known)
    question = BodyTask(request=request, with_glb=False)
    return BodyEstimate.model_validate_json(asked(BODY, question)[ANSWER])


def test_height_weight_and_measurements_are_known_alike():
    found = {
        each.name: each
        for each in answer(
            height_m=1.68,
            weight_kg=64.5,
            measurements={
                "waist_girth_navel": UncertainMeasurement(value=78.0, standard_error=1.5)
            },
        ).measurements
    }
    assert {name for name, each in found.items() if each.given} == {
        "stature",
        "weight",
        "waist_girth_navel",
    }
    assert found["stature"].value == pytest.approx(168.0, abs=0.01)
    assert found["weight"].value == pytest.approx(64.5, abs=0.01)
    assert 0.5 < found["waist_girth_navel"].standard_error < 1.5


@pytest.mark.parametrize(
    ("known", "field", "code"),
    [
        ({"height_m": 1.68, "weight_kg": 700.0}, "weight_kg", "out-of-range"),
        ({"measurements": {"weight": 700.0}}, "measurements.weight", "out-of-range"),
        ({"measurements": {"stature": 230.5}}, "measurements.stature", "out-of-range"),
        ({"measurements": {"bust": 90.0}}, "measurements.bust", "unknown-value"),
    ],
)
def test_what_nobody_is_is_refused_where_it_was_said(known, field, code):
    with pytest.raises(UnusableInputError) as caught:
        answer(**known)
    assert (caught.value.error.field, caught.value.error.code) == (field, code)
    assert caught.value.error.remedy


def sample_pose(**changes: object):
    options = InitialPoseRequest(
        gender=SAMPLE.gender,
        height_m=SAMPLE.height_m,
        points=SAMPLE.views[0].given_points,
        image_size=ImageSize(width=720, height=960),
    ).model_copy(update=changes)
    pose = asked(INITIAL_POSE, options)[ANSWER]
    return options, InitialPose.model_validate_json(pose)


def test_the_sample_s_clicks_give_a_body_near_them_with_an_outline_round_them():
    options, pose = sample_pose(focal_length_35mm=50.0)
    assert pose.height_m == options.height_m
    assert pose.focal_length_source == "caller"
    assert set(pose.residual_px) == set(options.points)
    assert sorted(pose.residual_px.values())[len(pose.residual_px) // 2] < 10.0
    corners = [corner for loop in pose.outline for corner in loop]
    for axis in (0, 1):
        low, high = min(each[axis] for each in corners), max(each[axis] for each in corners)
        assert low < pose.points["nose"][axis] < high
    assert any(reading.ambiguous for reading in pose.limbs)


def test_a_limb_whose_facing_is_said_faces_that_way_and_is_not_ambiguous():
    _, pose = sample_pose()
    limb = next(each for each in pose.limbs if each.ambiguous)
    other = Facing.TOWARD if limb.facing is Facing.AWAY else Facing.AWAY
    _, said = sample_pose(limb_facing={Limb(limb.limb): other})
    found = next(each for each in said.limbs if each.limb == limb.limb)
    assert (found.facing, found.ambiguous) == (other, False)


def test_a_pose_of_somebody_nobody_is_is_refused_where_it_was_said():
    with pytest.raises(UnusableInputError) as caught:
        sample_pose(weight_kg=70.0, measurements={"waist_girth_navel": 160.0})
    assert caught.value.error.code == "contradictory-measurements"


def test_points_of_the_sample_are_proposed_with_a_mask_of_its_size():
    sample = load_sample()
    task = PointsRequest(mask=True)
    proposal, file = points(task, sample.image)
    with Image.open(io.BytesIO(file)) as mask:
        assert (mask.mode, mask.size) == ("L", (720, 960))
    assert len(proposal.points) == 21
    assert proposal.doubtful == ()
    for point in proposal.points.values():
        assert Point.model_validate_json(point.model_dump_json()).source is PointSource.PROPOSAL


def sample_of_a_phone() -> bytes:
    """The sample as a phone writes it: lying, with its turn in the container and in EXIF."""
    return phone_picture(coded(SAMPLE_LYING), orientation=6, quarters=3, focal_length_35mm=50)


def test_points_of_a_heic_are_those_of_the_jpeg():
    found = [points(PointsRequest(), image) for image in (load_sample().image, sample_of_a_phone())]
    jpeg_points, heic_points = (proposal.points for proposal, _ in found)
    assert len(jpeg_points) >= 16
    assert jpeg_points.keys() == heic_points.keys()
    off = [
        ((jpeg_points[name].x - each.x) ** 2 + (jpeg_points[name].y - each.y) ** 2) ** 0.5
        for name, each in heic_points.items()
    ]
    assert sorted(off)[len(off) // 2] < 4.0


def test_a_heic_is_written_as_a_jpeg_that_stands_upright():
    written = Image.open(io.BytesIO(jpeg(sample_of_a_phone())))
    assert (written.format, written.size) == ("JPEG", (720, 960))
    assert written.getexif().get(0x0112, 1) == 1
    reference = Image.open(io.BytesIO(load_sample().image)).resize((72, 96)).convert("RGB")
    small = written.resize((72, 96))
    assert ImageStat.Stat(ImageChops.difference(small, reference)).mean < [8.0] * 3


def test_what_cannot_be_decoded_cannot_be_written_as_a_jpeg():
    with pytest.raises(UnusableInputError) as caught:
        jpeg(sample_of_a_phone()[:9_000])
    assert (caught.value.error.field, caught.value.error.code) == ("image", "image-damaged")


def checked_sample(*, detector: Path | None = None, **said: object):
    request = PointsRequest.model_validate(said)
    proposal, _ = points(request, load_sample().image, detector=detector)
    return proposal


def test_the_sample_is_not_seen_from_the_side_nor_far_enough_through_half_the_lens():
    found = checked_sample(view=ViewKind.SIDE, gender=Gender.MALE, focal_length_35mm=25.0)
    assert [(each.code, each.severity) for each in found.findings] == [
        ("other-view", Severity.BLOCKS),
        ("camera-too-near", Severity.HARMS),
    ]
    assert not found.usable
    assert [(each.code, "1.82 m" in each.reason) for each in found.assumptions] == [
        ("height-assumed", True)
    ]


def test_without_a_detector_points_are_checked_and_a_picture_alone_is_not(tmp_path):
    clicked = SAMPLE.views[0].given_points
    found = checked_sample(detector=tmp_path, points=clicked, view=ViewKind.FRONT)
    assert (found.findings, found.persons, found.seen_from) == ((), (), SeenFrom.FRONT)
    assert {each.code for each in found.not_checked} == {
        "nobody-found",
        "face-hidden",
        "several-people",
        "arms-against-trunk",
        "clothes-loose",
        "not-standing",
        "child",
    }
    assert found.distance_m == pytest.approx(checked_sample().distance_m, rel=0.05)
    with pytest.raises(ProblemError, match="detector-not-installed"):
        checked_sample(detector=tmp_path)


def test_what_is_wrong_with_a_picture_or_a_question_is_told_by_field(tmp_path):
    sample = load_sample()
    for person, image, field, code in (
        (1, sample.image, "person", "person-unknown"),
        (None, sample.image[:10_000], "image", "image-damaged"),
    ):
        task = PointsRequest(person=person)
        with pytest.raises(UnusableInputError) as caught:
            points(task, image)
        assert (caught.value.error.field, caught.value.error.code) == (field, code)
    with pytest.raises(ProblemError, match="detector-not-installed"):
        points(PointsRequest(), sample.image, detector=tmp_path)


def test_memory_that_runs_out_is_no_fault_of_the_picture_s(monkeypatch):
    def exhausted(*_: object) -> None:
        raise MemoryError

    monkeypatch.setattr("fitter.observation.decoding.as_srgb", exhausted)
    task = PointsRequest()
    with pytest.raises(UnusableInputError) as caught:
        points(task, load_sample().image)
    assert (caught.value.error.field, caught.value.error.code) == ("image", "out-of-memory")
