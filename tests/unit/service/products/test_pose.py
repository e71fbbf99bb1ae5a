"""The body in another pose, and what it wears there."""

import io

import numpy as np
import pytest
from PIL import Image

from api_schemas.products.base import BodyColours
from api_schemas.products.bodies import NamedPose
from fitter.applications.poses import NAMED_POSES, REST
from fitter.body.storage import load_body_model, packaged_model_path
from service.compute.tasks import UnusableInputError
from service.jobs.inputs import SEGMENTATION, of_view
from tests.unit.export.glb_reader import read_glb
from tests.unit.service.products.samples import made, png


def test_the_named_poses_of_the_wire_are_the_fitter_s():
    assert {pose.value for pose in NamedPose} == {REST, *NAMED_POSES}


def test_the_same_options_give_the_same_bytes():
    assert made(kind="pose").files == made(kind="pose").files


def test_a_named_pose_departs_where_it_is_told_to():
    standing = made(kind="pose", pose="standing").result.model_dump()["pose"]
    turned = made(kind="pose", pose="standing", rotations={"head": [0.0, 0.3, 0.0]})
    changed = {
        part: rotation
        for part, rotation in turned.result.model_dump()["pose"].items()
        if rotation != pytest.approx(standing[part], abs=1e-9)
    }
    assert changed == {"head": pytest.approx((0.0, 0.3, 0.0))}


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
    output = made(**asked)
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
    plain = made(**asked, colours="plain")
    nowhere = made(files={of_view(0, SEGMENTATION): png(66, 99, level=0)}, **asked)
    for output in (plain, nowhere):
        assert output.result.colours is BodyColours.PLAIN
        for name, content in output.files.items():
            if name.endswith(".glb"):
                assert "images" not in read_glb(content).document


def test_albedo_of_a_fit_without_light_is_refused_in_new_poses_too():
    with pytest.raises(UnusableInputError) as caught:
        made(kind="pose", colours="albedo")
    assert (caught.value.error.code, caught.value.error.field) == ("no-light", "colours")


@pytest.mark.parametrize(
    ("rotations", "field"),
    [
        ({"tail": [0.0, 0.0, 1.0]}, "rotations.tail"),
        ({"left_shin": [3.0, 0.0, 0.0]}, "rotations.left_shin"),
    ],
)
def test_a_pose_that_nobody_can_take_is_refused_with_the_field_and_what_to_do(rotations, field):
    with pytest.raises(UnusableInputError) as caught:
        made(kind="pose", rotations=rotations)
    assert caught.value.error.field == field
    assert caught.value.error.remedy
