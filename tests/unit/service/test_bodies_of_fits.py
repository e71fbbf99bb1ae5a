"""Bodies made of a finished fit: posed, moved, exaggerated, coloured; and every kind is whole."""

import io
import subprocess
import sys
from pathlib import Path
from typing import Any, get_args, get_type_hints

import numpy as np
import pytest
from PIL import Image

from api_schemas.products import AnyProductOptions, AnyProductResult, ProductRequest, product_id
from api_schemas.products.base import BodyColours, ProductKind
from api_schemas.products.bodies import NamedMotion, NamedPose
from fitter.applications.poses import NAMED_POSES, REST
from fitter.body.storage import load_body_model, packaged_model_path
from service.compute.pipeline import maker_of
from service.compute.products.finished_fit import Made
from service.compute.tasks import UnusableInputError
from service.jobs.inputs import CLIP, SEGMENTATION, of_view
from tests.unit.export.glb_reader import read_glb
from tests.unit.service.finished_fit import made, png


def test_the_named_poses_of_the_wire_are_the_fitter_s():
    assert {pose.value for pose in NamedPose} == {REST, *NAMED_POSES}


@pytest.mark.parametrize(
    ("asked", "picture", "count"),
    [
        ({"kind": "pose", "pose": "sitting"}, "pose.png", 1),
        ({"kind": "animation", "motion": "walk", "duration_s": 0.2}, "animation.webp", 2),
    ],
)
def test_the_picture_is_on_the_body_in_new_poses(asked, picture, count):
    output, model = made(**asked), load_body_model(packaged_model_path("female"))
    assert output.result.colours is BodyColours.PICTURE
    drawn = np.asarray(Image.open(io.BytesIO(output.files[picture])).convert("L"), dtype=int)
    assert (np.abs(drawn - 90) < 8).mean() > 0.9 * (drawn < 200).mean() > 0.05
    files = [name for name in output.files if name.endswith(".glb")]
    assert len(files) == count
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
    asked = {"kind": kind} | ({"motion": "walk", "duration_s": 0.1} if kind == "animation" else {})
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


MOTIONS = Path(__file__).parents[1] / "applications" / "data" / "bvh"


def test_the_poses_of_rigs_are_the_fitter_s():
    assert set(NamedMotion) - {NamedMotion.WALK} <= set(NAMED_POSES)


def test_a_pose_of_the_wire_is_a_rig_with_the_names_and_colours_that_are_asked_for():
    output = made(kind="animation", bones="unreal")
    assert set(output.files) == {"body_skinned.glb", "texture.jpg"}
    nodes = read_glb(output.files["body_skinned.glb"]).document["nodes"]
    assert {"pelvis", "clavicle_l", "calf_r"} < {node["name"] for node in nodes}
    assert (output.result.frames, output.result.motion) == (1, "a_pose")


def test_a_body_goes_its_way_only_if_that_is_asked_for():
    far, near = (
        made(kind="animation", motion="walk", duration_s=0.3, in_place=here)
        .files["motion.bvh"]
        .splitlines()
        for here in (False, True)
    )
    ways = [[float(lines[at].split()[2]) for at in (-9, -1)] for lines in (far, near)]
    assert abs(np.diff(ways[0])) > 20.0, "centimetres"
    assert abs(np.diff(ways[1])) < 5.0


@pytest.mark.parametrize(("duration_s", "frames"), [(0.001, 1), (0.2, 6)])
def test_a_walk_is_as_long_as_it_is_asked_to_be(duration_s: float, frames: int):
    result = made(
        kind="animation", motion="walk", start_s=100.0, duration_s=duration_s
    ).result.model_dump()
    assert (result["frames"], result["warnings"]) == (frames, ())


def test_a_clip_that_comes_along_is_what_moves_the_body_and_says_its_errors():
    with pytest.raises(UnusableInputError) as caught:
        made(files={CLIP: b"HIERARCHY\nROOT Hips\n{\n}\n"}, kind="animation")
    assert caught.value.error.field == "bvh"


def test_a_clip_moves_the_body_by_the_joints_and_the_axis_that_are_told():
    clip = (MOTIONS / "r_lafanlike.bvh").read_bytes().replace(b"LeftKnee", b"Knie L")
    clip = clip.replace(b"Frames: 40", b"Frames: 41")
    output = made(
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
        "animation.webp",
        "body_animated.glb",
        "body_skinned.glb",
        "motion.bvh",
        "texture.jpg",
    }


def test_a_caricature_says_what_was_exaggerated():
    output = made(kind="caricature", factor=1.5)
    result = output.result.model_dump()
    assert (result["coefficient"], result["before"], result["after"]) == (2, 1.0, 1.5)
    glb = read_glb(output.files["body_caricature.glb"])
    positions = glb.attribute("POSITION")
    assert positions[:, 1].min() == pytest.approx(0.0, abs=1e-6)
    assert glb.document["asset"]["extras"]["factor"] == 1.5


def test_a_caricature_of_looks_exaggerates_every_coefficient():
    fitted = made(kind="caricature", exaggerated="looks", factor=1.0).result.model_dump()
    looks = made(kind="caricature", exaggerated="looks", factor=1.5)
    result = looks.result.model_dump()
    assert result["shape"][1:] == pytest.approx([1.5 * value for value in fitted["shape"][1:]])
    extras = read_glb(looks.files["body_caricature.glb"]).document["asset"]["extras"]
    assert extras["exaggerated"] == "looks"


def test_a_factor_that_turns_the_surface_inside_out_is_refused_with_the_largest():
    with pytest.raises(UnusableInputError) as caught:
        made(kind="caricature", factor=99.0)
    assert caught.value.error.field == "factor"
    assert caught.value.error.largest < 99.0


OPTIONS: dict[str, Any] = {
    tag.tag.strip("[]"): model for model, tag in map(get_args, get_args(AnyProductOptions))
}
RESULTS: dict[str, Any] = {
    get_args(model.model_fields["kind"].annotation)[0]: model
    for model in get_args(get_args(AnyProductResult)[0])
}


def test_every_kind_has_options_and_a_result():
    assert list(OPTIONS) == list(RESULTS) == list(ProductKind)


@pytest.mark.parametrize("kind", ProductKind)
def test_what_makes_a_kind_takes_its_options_and_gives_its_result(kind: str):
    for model in (OPTIONS[kind], RESULTS[kind]):
        assert get_args(model.model_fields["kind"].annotation) == (kind,)
    hints = get_type_hints(maker_of(kind))
    assert hints["options"] == OPTIONS[kind]
    assert hints["return"] == Made[RESULTS[kind]]


def asked(text: str, part: bytes | None = None) -> str:
    return product_id(ProductRequest.model_validate_json(text).root, part)


def test_an_id_is_of_the_options_as_understood_and_of_the_part():
    plain = asked('{"kind": "caricature"}')
    assert plain == asked('{"factor": 2, "kind": "caricature"}')
    assert plain != asked('{"kind": "caricature", "factor": 2.5}')
    turned = [
        asked('{"kind": "pose", "rotations": {"head": [0, 0, 1], "left_hand": [0, 0, 1]}}'),
        asked('{"kind": "pose", "rotations": {"left_hand": [0, 0, 1], "head": [0, 0, 1]}}'),
    ]
    assert turned[0] == turned[1]
    sent = {asked('{"kind": "size"}', part) for part in (None, b"", b"a", b"b")}
    assert len(sent) == 4


def test_a_process_for_fits_has_loaded_nothing_that_makes_products():
    """Every process forked for a fit would carry more along."""
    code = (
        "import sys, service.compute.child, service.compute.pipeline;"
        "print([each for each in sys.modules if each.startswith('service.compute.products.')])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, text=True)
    assert done.stdout.strip() == "['service.compute.products.finished_fit']"
