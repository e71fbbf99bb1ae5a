"""The body in motion: by name, or by a BVH file."""

from pathlib import Path

import numpy as np
import pytest

from api_schemas.products.bodies import NamedMotion
from fitter.applications.named_motions import NAMED_MOTIONS
from service.compute.tasks import UnusableInputError
from service.jobs.inputs import CLIP
from tests.unit.export.glb_reader import read_glb
from tests.unit.service.products.samples import made

MOTIONS = Path(__file__).parents[2] / "applications" / "data" / "bvh"


def test_the_named_motions_of_the_wire_are_the_fitter_s():
    assert [motion.value for motion in NamedMotion] == list(NAMED_MOTIONS)


def test_a_body_moves_as_the_named_motion_says():
    waving, squatting = (
        made(kind="animation", motion=motion, start_s=1.3, duration_s=0.1)
        for motion in ("wave", "squat")
    )
    assert (waving.result.motion, squatting.result.motion) == ("wave", "squat")
    assert squatting.result.source == "the squat that ships with the package"
    high, low = (
        read_glb(each.files["body_animated.glb"]).attribute("POSITION")[:, 1]
        for each in (waving, squatting)
    )
    assert np.ptp(low) < 0.8 * np.ptp(high)


@pytest.mark.parametrize(("duration_s", "frames"), [(0.001, 1), (0.2, 6)])
def test_a_walk_is_as_long_as_it_is_asked_to_be(duration_s: float, frames: int):
    result = made(kind="animation", start_s=100.0, duration_s=duration_s).result.model_dump()
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
        "texture.jpg",
    }
