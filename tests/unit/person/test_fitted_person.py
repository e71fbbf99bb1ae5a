"""A fitted person as it is kept, and the world in which it stands upright."""

import io
import json
from dataclasses import asdict, replace
from zipfile import ZIP_STORED

import numpy as np
import pytest

from fitter.body.storage import write_arrays
from fitter.errors import InvalidInputError
from fitter.parameters import CameraTilt
from fitter.person.fitted_person import FittedPerson, require_model
from fitter.person.upright import upright_frame, upright_rotation, upright_turn
from fitter.vocabulary.outcomes import StanceKind
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.results import CAMERA, SUN, result_of

MODEL = bar_model()
COLOURS = np.random.default_rng(1).uniform(0.0, 1.2, size=(len(MODEL.mean_vertices), 3))

TILT = CameraTilt(
    pitch=-0.12,
    roll=0.03,
    covariance=np.array([[2e-3, 1e-4], [1e-4, 1e-3]]),
    stances={StanceKind.STANDING: 0.9, StanceKind.STRIDING: 0.08, StanceKind.OTHER: 0.02},
)

PEOPLE = {
    "point light": result_of(MODEL).person,
    "directional light": result_of(MODEL, light=SUN).person,
    "coloured": result_of(MODEL, albedo_rgb=COLOURS).person,
    "without shading": result_of(MODEL, light=None).person,
    "tilt": replace(result_of(MODEL).person, tilt=TILT),
}


def members(person: FittedPerson) -> dict[str, np.ndarray]:
    with np.load(io.BytesIO(person.to_bytes())) as archive:
        return {name: archive[name] for name in archive.files}


def packed(arrays: dict[str, np.ndarray]) -> bytes:
    stream = io.BytesIO()
    write_arrays(stream, arrays, compression=ZIP_STORED)
    return stream.getvalue()


def refusal(content: bytes) -> InvalidInputError:
    with pytest.raises(InvalidInputError) as caught:
        FittedPerson.from_bytes(content)
    assert caught.value.code == "person-unusable"
    return caught.value


@pytest.mark.parametrize("kind", PEOPLE)
def test_every_number_comes_back_as_it_was(kind):
    person = PEOPLE[kind]
    found = FittedPerson.from_bytes(person.to_bytes())
    assert (found.gender, found.model_checksum) == (person.gender, person.model_checksum)
    assert found.camera == person.camera == CAMERA
    assert (found.light is None) == (person.light is None)
    if person.light is not None:
        assert asdict(found.light) == asdict(person.light)
    for name in ("pose", "translation", "shape"):
        np.testing.assert_array_equal(getattr(found.body, name), getattr(person.body, name))
    if person.reflectance is None:
        assert found.reflectance is None
    else:
        for name in ("albedo", "specularity", "ambient", "specular_exponent"):
            np.testing.assert_array_equal(
                getattr(found.reflectance, name), getattr(person.reflectance, name)
            )
    if person.albedo_rgb is None:
        assert found.albedo_rgb is None
    else:
        np.testing.assert_array_equal(found.albedo_rgb, person.albedo_rgb)
    assert (found.tilt is None) == (person.tilt is None)
    if found.tilt is not None and person.tilt is not None:
        assert (found.tilt.pitch, found.tilt.roll) == (person.tilt.pitch, person.tilt.roll)
        assert found.tilt.stances == person.tilt.stances
        np.testing.assert_array_equal(found.tilt.covariance, person.tilt.covariance)


@pytest.mark.parametrize("kind", PEOPLE)
def test_the_same_person_gives_the_same_bytes(kind):
    content = PEOPLE[kind].to_bytes()
    assert FittedPerson.from_bytes(content).to_bytes() == content


@pytest.mark.parametrize(
    "content", [b"", b"PK", b"no archive", PEOPLE["coloured"].to_bytes()[:-90]]
)
def test_what_is_no_archive_is_refused(content):
    assert refusal(content).field == "person.file"


def test_an_archive_of_pickles_is_refused():
    stream = io.BytesIO()
    np.savez(stream, pose=np.array([object()]))
    assert refusal(stream.getvalue()).field == "person.file"


@pytest.mark.parametrize(("field", "change"), [("format_version", 2), ("gender", "neutral")])
def test_a_header_that_means_something_else_is_refused(field, change):
    arrays = members(PEOPLE["coloured"])
    header = json.loads(arrays["header"].tobytes()) | {field: change}
    encoded = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    assert str(change) in refusal(packed(arrays | {"header": encoded})).reason


@pytest.mark.parametrize("field", ["header", "pose", "camera", "albedo"])
def test_a_missing_field_is_named(field):
    arrays = members(PEOPLE["coloured"])
    del arrays[field]
    assert field in refusal(packed(arrays)).reason


def test_a_byte_that_is_another_is_noticed():
    content = bytearray(PEOPLE["coloured"].to_bytes())
    content[len(content) // 2] ^= 1
    assert "CRC" in refusal(bytes(content)).reason


def test_a_person_belongs_to_the_model_it_was_fitted_with():
    require_model(PEOPLE["coloured"], MODEL)
    others = {
        "gender": replace(MODEL, gender="male"),
        "model_checksum": replace(MODEL, header={"checksum": "another"}),
        "shape": replace(
            MODEL,
            shape_basis=MODEL.shape_basis[:1],
            pose_feature_strengths=MODEL.pose_feature_strengths[..., :1],
        ),
        "albedo": bar_model(rings=12),
    }
    for field, model in others.items():
        with pytest.raises(InvalidInputError) as caught:
            require_model(PEOPLE["coloured"], model)
        assert caught.value.field == f"person.{field}"


STEEP = CameraTilt(
    pitch=np.radians(-12.0),
    roll=np.radians(3.0),
    covariance=np.eye(2),
    stances={StanceKind.STANDING: 1.0},
)


def test_a_level_camera_looks_along_minus_z():
    level = CameraTilt(pitch=0.0, roll=0.0, covariance=np.eye(2), stances=STEEP.stances)
    frame = upright_frame(level, vertices=np.array([[0.0, 1.0, 3.0]]), root=np.array([0.2, 0, 3.0]))
    np.testing.assert_allclose(frame.rotation.T, np.diag([1.0, -1.0, -1.0]), atol=1e-15)
    np.testing.assert_allclose(frame.translation, [-0.2, 1.0, 3.0])


def test_what_is_above_in_the_camera_frame_is_above_in_the_world():
    vertices = np.random.default_rng(0).standard_normal((30, 3)) + [0.0, 0.0, 4.0]
    frame = upright_frame(STEEP, vertices=vertices, root=vertices[0])
    world = frame.points(vertices)
    np.testing.assert_allclose(world[:, 1].min(), 0.0, atol=1e-12)
    np.testing.assert_allclose(world[0, [0, 2]], 0.0, atol=1e-12)
    heights = vertices @ STEEP.up
    np.testing.assert_allclose(world[:, 1], heights - heights.min(), atol=1e-12)


def test_a_camera_that_looks_down_is_above_what_it_looks_at():
    ahead = np.array([[0.0, 0.0, 3.0]])
    frame = upright_frame(STEEP, vertices=ahead, root=ahead[0])
    np.testing.assert_allclose(frame.translation[1], 3.0 * np.sin(np.radians(12.0)))


def test_a_turn_of_axes_with_y_up_is_the_rotation_of_the_camera_frame():
    body_axes = np.random.default_rng(1).standard_normal((5, 3))
    np.testing.assert_allclose(
        body_axes @ upright_turn(STEEP).T, (body_axes * [1, -1, -1]) @ upright_rotation(STEEP).T
    )
    np.testing.assert_array_equal(upright_turn(None), np.eye(3))
