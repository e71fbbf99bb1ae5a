"""Animated files in formats that know no motion: the body where its first frame has it."""

import io

import numpy as np
import pytest
import trimesh

from fitter.applications.animated_glb import morphed_glb, skin_of, skinned_glb
from fitter.applications.motion import grounded, motion_of_cycle, moving_body
from fitter.applications.named_motions import stride_of
from fitter.applications.principal_frames import principal_frames
from fitter.export.formats import converted
from tests.unit.applications.bodies import packaged


@pytest.fixture(scope="module")
def body():
    return packaged("male")


@pytest.fixture(scope="module")
def moving(body):
    """A stride that begins turned away and off the middle."""
    motion = motion_of_cycle(stride_of(body.rig), body.rig, frames=stride_of(body.rig).frames)
    motion.poses[:, 0, 1] = np.linspace(1.0, 2.0, len(motion.poses))
    motion.roots[:, 0] += 0.5
    return grounded(moving_body(body.evaluator, body.shape, motion), body.model)


def vertices_of(glb: bytes) -> np.ndarray:
    read = trimesh.load_mesh(io.BytesIO(converted(glb, "ply")), file_type="ply", process=False)
    return read.vertices


def test_morph_targets_give_the_exact_first_body(body, moving):
    exact = principal_frames(moving.shapes)
    glb = morphed_glb(moving, exact, body.model, reflectance=None, albedo_rgb=None)
    np.testing.assert_allclose(vertices_of(glb), moving.vertices(0), atol=2e-6)


def test_bones_give_the_first_body_within_the_skins_error(body, moving):
    skin = skin_of(moving, body.model)
    glb = skinned_glb(moving, skin, body.model, reflectance=None, albedo_rgb=None)
    away = np.linalg.norm(vertices_of(glb) - moving.vertices(0), axis=1)
    assert away.max() <= skin.largest_error_m + 1e-5
    bound = np.linalg.norm(skin.vertices - moving.vertices(0), axis=1)
    assert away.max() < 0.2 * bound.min()
