"""Bone centres told by the skin around them, on MakeHuman's bodies."""

from functools import cache

import numpy as np
import pytest

from fitter.training.articulation import bone_centres
from fitter.training.articulation.bone_centres import (
    sample_sources,
    turning_bones,
    with_skin_centres,
)
from fitter.training.articulation.rig import Rig, bone_heads
from tests.unit.training.makehuman_data import base_mesh, body_space, needs_makehuman
from tests.unit.training.rigged_neutral import neutral_source, rig

pytestmark = needs_makehuman

FEW = 40
"""Bodies that the centres are fitted on here."""


@cache
def fitted() -> Rig:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bone_centres, "SAMPLES", FEW)
        return with_skin_centres(rig(), base_mesh(), body_space("female"))


def names() -> list[str]:
    return [rig().bone_names[bone] for bone in turning_bones(rig())]


def bone(name: str) -> int:
    return rig().bone_names.index(name)


def test_limbs_and_trunk_turn_and_fingers_toes_and_face_do_not():
    assert {"root", "upperarm01.L", "lowerarm01.R", "upperleg01.L", "foot.R"} <= set(names())
    assert not any(name.startswith(("finger", "toe", "eye", "jaw")) for name in names())


def test_centres_are_weighted_means_of_the_body_alone():
    rows = fitted().head_rows.toarray()[turning_bones(rig())]
    helpers = np.setdiff1d(np.arange(rows.shape[1]), base_mesh().body_vertex_ids)
    assert (rows >= 0.0).all()
    np.testing.assert_allclose(rows.sum(axis=1), 1.0, atol=1e-9)
    assert len(helpers) > 1000
    assert not rows[:, helpers].any()


def test_centres_come_near_the_cubes_of_the_rig():
    found, cubes = (bone_heads(each, neutral_source()) for each in (fitted(), rig()))
    distances_mm = 1000.0 * np.linalg.norm(found - cubes, axis=1)
    assert distances_mm[turning_bones(rig())].mean() < 12.0
    for name in ("upperleg01.L", "lowerleg01.L", "lowerarm01.L", "wrist.L"):
        assert distances_mm[bone(name)] < 8.0


def test_bones_that_do_not_turn_keep_their_cubes():
    others = np.setdiff1d(np.arange(len(rig().bone_names)), turning_bones(rig()))
    assert len(others) > 20
    assert abs(fitted().head_rows[others] - rig().head_rows[others]).max() == 0.0


def test_bones_within_a_limb_lie_on_the_line_between_its_ends():
    heads = bone_heads(fitted(), neutral_source())
    for middle, first, last in (
        ("upperarm02", "upperarm01", "lowerarm01"),
        ("lowerleg02", "lowerleg01", "foot"),
    ):
        start, end, point = (heads[bone(f"{name}.R")] for name in (first, last, middle))
        way = (end - start) / np.linalg.norm(end - start)
        along = (point - start) @ way
        assert 0.0 < along < np.linalg.norm(end - start)
        np.testing.assert_allclose(point, start + along * way, atol=1e-6)


def test_right_bones_mirror_left_ones_and_the_spine_lies_in_the_middle():
    base, symmetric = base_mesh(), neutral_source().copy()
    body = base.body(symmetric)
    mirrored = body[base.mirror] * [-1.0, 1.0, 1.0]
    symmetric[base.body_vertex_ids] = 0.5 * (body + mirrored)
    heads = bone_heads(fitted(), symmetric)
    for name in names():
        stem, _, side = name.partition(".")
        if side == "L":
            mirrored = heads[bone(f"{stem}.R")] * [-1.0, 1.0, 1.0]
            np.testing.assert_allclose(heads[bone(name)], mirrored, atol=1e-6)
        elif not side:
            assert abs(heads[bone(name), 0]) < 1e-6


def test_samples_are_the_same_every_time_and_differ_from_one_another(monkeypatch):
    monkeypatch.setattr(bone_centres, "SAMPLES", 2)
    first, second = (sample_sources(body_space("female")) for _ in range(2))
    np.testing.assert_array_equal(first, second)
    assert np.linalg.norm(first[0] - first[1], axis=1).mean() > 0.01
