"""What derives a kind makes do with what the kind needs, and says what the fitter knows."""

import io
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.animation import NamedMotion
from api_schemas.derivation_kinds.base import BodyColours
from api_schemas.derivation_kinds.pose import NamedPose
from api_schemas.derivation_kinds.texture import LEAST_OWN_TEXTURE, TEXTURE_SIZES
from api_schemas.derivations import DerivationResult
from fitter.applications.named_motions import NAMED_MOTIONS
from fitter.applications.own_texture import LEAST_SIDE
from fitter.applications.poses import NAMED_POSES, REST
from fitter.applications.texture import SIZES
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import Light, Reflectance
from fitter.vocabulary.choices import LightKind
from service.jobs.inputs import (
    CLIP,
    PERSON,
    RESULT,
    SEGMENTATION,
    TEXTURE,
)
from service.worker.files import MEDIA_TYPES, with_result_document
from service.worker.pipeline_port import (
    UnusableInputError,
)
from tests.unit.export.glb_reader import read_glb
from tests.unit.service.derivation_samples import (
    NEEDED,
    derived,
    person,
    png,
)

MOTIONS = Path(__file__).parents[1] / "applications" / "data" / "bvh"


def test_the_named_poses_of_the_wire_are_the_fitter_s():
    assert {pose.value for pose in NamedPose} == {REST, *NAMED_POSES}


def test_the_named_motions_of_the_wire_are_the_fitter_s():
    assert [motion.value for motion in NamedMotion] == list(NAMED_MOTIONS)


def test_a_body_moves_as_the_named_motion_says():
    waving, squatting = (
        derived(kind="animation", motion=motion, start_s=1.3, duration_s=0.1)
        for motion in ("wave", "squat")
    )
    assert (waving.result.motion, squatting.result.motion) == ("wave", "squat")
    assert squatting.result.source == "the squat that ships with the package"
    high, low = (
        read_glb(each.files["body_animated.glb"]).attribute("POSITION")[:, 1]
        for each in (waving, squatting)
    )
    assert np.ptp(low) < 0.8 * np.ptp(high)


@pytest.mark.parametrize("kind", list(DerivationKind))
def test_a_derivation_s_document_lists_its_files_and_is_of_its_type(kind):
    output = derived(kind=kind, **NEEDED.get(kind, {}))
    assert {f".{name.rpartition('.')[2]}" for name in output.files} <= set(MEDIA_TYPES)
    files = with_result_document(output.result, output.files)
    document = DerivationResult.model_validate_json(files[RESULT]).root
    assert document.kind == kind
    assert {each.name for each in document.files} == set(output.files)


def test_the_same_derivation_gives_the_same_bytes():
    assert derived(kind="pose").files == derived(kind="pose").files


def test_a_caricature_says_what_was_exaggerated():
    output = derived(kind="caricature", factor=1.5)
    result = output.result.model_dump()
    assert (result["coefficient"], result["before"], result["after"]) == (2, 1.0, 1.5)
    glb = read_glb(output.files["body_caricature.glb"])
    positions = glb.attribute("POSITION")
    assert positions[:, 1].min() == pytest.approx(0.0, abs=1e-6)
    assert glb.document["asset"]["extras"]["factor"] == 1.5


def test_a_caricature_of_looks_exaggerates_every_coefficient():
    fitted = derived(kind="caricature", exaggerated="looks", factor=1.0).result.model_dump()
    looks = derived(kind="caricature", exaggerated="looks", factor=1.5)
    result = looks.result.model_dump()
    assert result["shape"][1:] == pytest.approx([1.5 * value for value in fitted["shape"][1:]])
    extras = read_glb(looks.files["body_caricature.glb"]).document["asset"]["extras"]
    assert extras["exaggerated"] == "looks"


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


@pytest.mark.parametrize(
    ("asked", "files"),
    [
        ({"kind": "pose", "pose": "sitting"}, ["body_reposed.glb"]),
        (
            {"kind": "animation", "duration_s": 0.2},
            ["body_animated.glb", "body_skinned.glb"],
        ),
    ],
)
def test_the_picture_is_on_the_body_in_new_poses(asked, files):
    output = derived(**asked)
    assert output.result.colours is BodyColours.PICTURE
    model = load_body_model(packaged_model_path("female"))
    for name in files:
        glb = read_glb(output.files[name])
        (image,) = glb.document["images"]
        view = glb.document["bufferViews"][image["bufferView"]]
        encoded = glb.binary[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        with Image.open(io.BytesIO(encoded)) as texture:
            assert (texture.format, texture.size) == ("JPEG", (1024, 1024))
            levels = np.asarray(texture, dtype=int)
        # The whole picture has this one level; but for where JPEG blurs the islands' black ends.
        assert np.percentile(np.abs(levels - 90)[levels > 60], 99) < 4
        owners = glb.attribute("_VERTEX").ravel().astype(int)
        assert np.array_equal(
            owners[: len(model.mean_vertices)], np.arange(len(model.mean_vertices))
        )
        corners = glb.accessor(glb.document["meshes"][0]["primitives"][0]["indices"])
        assert np.array_equal(owners[corners.reshape(-1, 3)], model.triangles)
        texels = glb.attribute("TEXCOORD_0")[corners.reshape(-1, 3)]
        asked_texels = model.uv[model.uv_triangles] * [1.0, -1.0] + [0.0, 1.0]
        assert np.abs(texels - asked_texels).max() < 1e-6
        counts = {
            glb.document["accessors"][accessor]["count"]
            for attributes in (glb.attributes, *_targets(glb))
            for accessor in attributes.values()
        }
        assert counts == {len(model.uv)}
        assert "KHR_materials_unlit" in glb.document["extensionsUsed"]
        assert "extensions" not in glb.document


def _targets(glb):
    return glb.document["meshes"][0]["primitives"][0].get("targets", ())


@pytest.mark.parametrize("kind", ["pose", "animation"])
def test_a_body_in_a_new_pose_is_plain_if_asked_for_or_if_nothing_is_seen(kind):
    asked = {"kind": kind} | ({"duration_s": 0.1} if kind == "animation" else {})
    plain = derived(**asked, colours="plain")
    nowhere = derived(files={SEGMENTATION: png(66, 99, level=0)}, **asked)
    for output in (plain, nowhere):
        assert output.result.colours is BodyColours.PLAIN
        for name, content in output.files.items():
            if name.endswith(".glb"):
                assert "images" not in read_glb(content).document


def test_albedo_of_a_fit_without_light_is_refused_in_new_poses_too():
    with pytest.raises(UnusableInputError) as caught:
        derived(kind="pose", colours="albedo")
    assert (caught.value.error.code, caught.value.error.field) == ("no-light", "colours")


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
    assert set(output.files) == {"body_textured.glb", "texture.png", "atlas.png"}
    result = output.result.model_dump()
    assert (result["colours"], result["size"], result["scale"]) == ("own", 96, 1.0)
    assert (result["seen_share"], result["mirrored_share"]) == (0.0, 0.0)
    texture = np.asarray(Image.open(io.BytesIO(output.files["texture.png"])))
    assert texture.shape == (96, 96, 3)
    assert set(np.unique(texture)) == {0, 131}
    assert Image.open(io.BytesIO(output.files["atlas.png"])).mode == "RGBA"
    glb = read_glb(output.files["body_textured.glb"])
    assert glb.document.get("extensionsUsed", []) == extensions
    view = glb.document["bufferViews"][glb.document["images"][0]["bufferView"]]
    start = view["byteOffset"]
    stored = glb.binary[start : start + view["byteLength"]]
    assert stored == output.files["texture.png"]


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


def test_a_clip_moves_the_body_by_the_joints_and_the_axis_that_are_told():
    clip = (MOTIONS / "r_lafanlike.bvh").read_bytes().replace(b"LeftKnee", b"Knie L")
    clip = clip.replace(b"Frames: 40", b"Frames: 41")
    output = derived(
        files={CLIP: clip},
        kind="animation",
        start_s=1.0,
        duration_s=0.4,
        joints={"left_shin": "Knie L"},
        up="y",
    )
    result = output.result.model_dump()
    assert (result["source"], result["up"]) == ("BVH with the names of CMU", "y")
    assert result["frames"] == 3
    assert [warning["code"] for warning in result["warnings"]] == ["bvh-irregular"]
    assert set(output.files) == {
        "animation.png",
        "animation.webp",
        "body_animated.glb",
        "body_skinned.glb",
        "texture.jpg",
    }


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
