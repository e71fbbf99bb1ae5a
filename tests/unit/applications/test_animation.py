import io
import itertools
import json
from dataclasses import replace

import numpy as np
import pytest
from PIL import Image
from scipy.spatial.transform import Rotation

from fitter.applications.animated_glb import morphed_glb, quaternions, skin_of, skinned_glb
from fitter.applications.animation import (
    MOST_FRAMES,
    ChosenMotion,
    animate,
    motion_of_clip,
    rigged,
    way_warnings,
)
from fitter.applications.bvh_export import bvh_of_motion
from fitter.applications.motion import (
    SLOWEST_M_PER_S,
    grounded,
    motion_of_cycle,
    moving_body,
    sliding_m,
    unturned,
)
from fitter.applications.motion_file import read_motion
from fitter.applications.poses import named_pose
from fitter.applications.principal_frames import ERROR_GOAL_M, principal_frames
from fitter.applications.skeleton import BONE_NAMES, skeleton_of
from fitter.applications.walk import stride_of
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson
from fitter.vocabulary.choices import BoneNames, Gender
from tests.unit.applications.bodies import packaged
from tests.unit.applications.bvh_files import MIXAMO, bvh_of
from tests.unit.export.glb_reader import read_glb
from tests.unit.export.results import CAMERA, POINT_LIGHT, reflectance_of


@pytest.fixture(scope="module")
def body():
    return packaged("male")


@pytest.fixture(scope="module")
def moving(body):
    """A stride, turning a little, so that the whole body's rotation matters."""
    motion = motion_of_cycle(stride_of(body.rig), body.rig, frames=stride_of(body.rig).frames)
    motion.poses[:, 0, 1] = np.linspace(0.0, 1.0, len(motion.poses))
    return grounded(moving_body(body.evaluator, body.shape, motion), body.model)


@pytest.fixture(scope="module")
def exact(moving):
    return principal_frames(moving.shapes)


@pytest.fixture(scope="module")
def skeleton(body):
    return skeleton_of(body.evaluator, body.shape, body.rig, BoneNames.MAQUETTE)


@pytest.fixture(scope="module")
def skin(body, moving, skeleton):
    return skin_of(moving, body.model, skeleton)


def channel(glb, path, node):
    """Samples of a node's path, and its times."""
    animation = glb.document["animations"][0]
    (found,) = (c for c in animation["channels"] if c["target"] == {"node": node, "path": path})
    sampler = animation["samplers"][found["sampler"]]
    return glb.accessor(sampler["output"]), glb.accessor(sampler["input"])


def test_turning_the_pelvis_turns_the_exact_body_as_a_whole(body, moving):
    frame = len(moving.shapes) // 2
    pose = moving.motion.poses[frame]
    whole = body.evaluator.body_frame_vertices(
        BodyParameters(pose=pose, translation=np.zeros(3), shape=body.shape)
    )
    np.testing.assert_allclose(moving.vertices(frame) - moving.roots[frame], whole, atol=1e-6)
    assert (unturned(pose)[0] == 0.0).all()
    np.testing.assert_array_equal(unturned(pose)[1:], pose[1:])


def test_principal_frames_are_within_the_error_they_state(moving, exact):
    rebuilt = exact.base + np.einsum("tk,kmi->tmi", exact.weights, exact.targets)
    errors = np.linalg.norm(rebuilt - moving.shapes, axis=2)
    assert errors.max() == pytest.approx(exact.largest_error_m, rel=0.01)
    assert errors.mean() == pytest.approx(exact.mean_error_m, rel=0.01)
    assert exact.largest_error_m <= ERROR_GOAL_M
    assert len(exact.targets) < len(moving.shapes) / 2


def test_principal_frames_begin_with_the_first_body_itself(moving, exact):
    np.testing.assert_array_equal(exact.base, moving.shapes[0])
    first = np.einsum("k,kmi->mi", exact.weights[0], exact.targets)
    np.testing.assert_allclose(first, 0.0, atol=1e-6)


def test_weights_are_what_programs_that_clamp_them_play(exact):
    assert exact.weights.min() == 0.0
    assert exact.weights.max() == 1.0


def test_bodies_that_span_a_plane_need_two_targets_and_the_one_that_cancels_them():
    rng = np.random.default_rng(2)
    base, first, second = rng.normal(size=(3, 40, 3)).astype(np.float32)
    steps = rng.normal(size=(9, 2)).astype(np.float32)
    shapes = base + np.einsum("tk,kmi->tmi", steps, np.stack([first, second]))
    found = principal_frames(shapes)
    assert len(found.targets) == 3
    assert found.largest_error_m < 1e-5


def test_a_body_that_does_not_move_has_no_error():
    shapes = np.repeat(np.random.default_rng(0).normal(size=(1, 20, 3)), 3, axis=0)
    for frames in (1, 3):
        found = principal_frames(shapes[:frames].astype(np.float32))
        assert found.largest_error_m == 0.0
        assert len(found.targets) == 2
        np.testing.assert_array_equal(found.targets, 0.0)
        assert np.isfinite(found.weights).all()


def test_the_morphed_file_plays_the_exact_bodies(body, moving, exact):
    """Read back as a viewer does: targets by weights, then rotation, then translation."""
    glb = read_glb(morphed_glb(moving, exact, body.model, reflectance=None, albedo_rgb=None))
    base = glb.attribute("POSITION")
    primitive = glb.document["meshes"][0]["primitives"][0]
    targets = np.stack([glb.accessor(target["POSITION"]) for target in primitive["targets"]])
    weights, times = channel(glb, "weights", 0)
    weights = weights.reshape(len(times), len(targets))
    rotations, _ = channel(glb, "rotation", 0)
    translations, _ = channel(glb, "translation", 0)
    np.testing.assert_allclose(np.diff(times.ravel()), moving.motion.frame_time_s, rtol=1e-3)
    for frame in (0, 7, len(times) - 1):
        shape = base + np.einsum("k,kmi->mi", weights[frame], targets)
        shown = Rotation.from_quat(rotations[frame]).apply(shape) + translations[frame]
        apart = np.linalg.norm(shown - moving.vertices(frame), axis=1)
        assert apart.max() <= exact.largest_error_m + 1e-5
        assert abs(shown[:, 1].min()) < exact.largest_error_m + 1e-5


def depth(node, parents):
    return 1 + depth(parents[node], parents) if node in parents else 0


def test_the_skinned_file_plays_what_its_stated_error_says(body, moving, skin):
    """Read back as a viewer does: Σ w G G_bind⁻¹ v over the bones' nodes."""
    glb = read_glb(skinned_glb(moving, skin, body.model, reflectance=None, albedo_rgb=None))
    document = glb.document
    extras = document["scenes"][0]["extras"]
    assert "approximate" in extras["method"]
    vertices = np.c_[glb.attribute("POSITION"), np.ones(len(skin.vertices))]
    parts = glb.attribute("JOINTS_0").astype(int)
    weights = glb.attribute("WEIGHTS_0")
    np.testing.assert_allclose(weights.sum(axis=1), 1.0, atol=1e-6)
    assert (parts[weights == 0.0] == 0).all()
    nodes = document["skins"][0]["joints"]
    inverse = glb.accessor(document["skins"][0]["inverseBindMatrices"])
    inverse = inverse.reshape(-1, 4, 4).transpose(0, 2, 1)
    parents = {
        child: node
        for node, entry in enumerate(document["nodes"])
        for child in entry.get("children", ())
    }
    errors = []
    for frame in range(len(moving.shapes)):
        world = {}
        for node in sorted(nodes, key=lambda node: depth(node, parents)):
            local = np.eye(4)
            local[:3, :3] = Rotation.from_quat(channel(glb, "rotation", node)[0][frame]).as_matrix()
            local[:3, 3] = channel(glb, "translation", node)[0][frame]
            world[node] = world[parents[node]] @ local if node in parents else local
        motions = np.stack([world[node] for node in nodes]) @ inverse
        blended = np.einsum("mb,mbij,mj->mi", weights, motions[parts], vertices)[:, :3]
        errors.append(np.linalg.norm(blended - moving.vertices(frame), axis=1))
    assert 1e3 * np.max(errors) == pytest.approx(extras["largest_error_mm"], rel=0.01)
    assert 1e3 * np.mean(errors) == pytest.approx(extras["mean_error_mm"], rel=0.01)
    assert np.max(errors[skin.frame]) < 1e-5
    assert extras["mean_error_mm"] < 2.0


def test_quaternions_never_change_their_sign_from_frame_to_frame():
    angles = np.linspace(0.0, 4.0 * np.pi, 60)
    vectors = Rotation.from_rotvec(angles[:, None] * [0.0, 0.6, 0.8]).as_rotvec()
    found = quaternions(vectors)
    assert (np.einsum("ti,ti->t", found[1:], found[:-1]) > 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), 1.0)
    np.testing.assert_allclose(
        Rotation.from_quat(found).as_matrix(), Rotation.from_rotvec(vectors).as_matrix(), atol=1e-12
    )


def clip_of(body, frames, frame_time_s):
    poses = np.repeat(named_pose(body.rig, "standing")[None], frames, axis=0)
    poses[:, 0, 1] = np.linspace(0.0, 0.5, frames)
    roots = np.tile([0.0, 0.9, 0.0], (frames, 1))
    return bvh_of(body.rig, names=MIXAMO, poses=poses, roots=roots, frame_time_s=frame_time_s)


@pytest.mark.parametrize(
    ("hertz", "frames", "expected", "expected_hertz"),
    [(120, 48, 12, 30), (60, 31, 16, 30), (100, 40, 10, 25), (25, 9, 9, 25), (30, 9, 9, 30)],
)
def test_clips_are_thinned_out_by_whole_steps(body, hertz, frames, expected, expected_hertz):
    found = motion_of_clip(read_motion(clip_of(body, frames, 1 / hertz)), body.rig)
    assert len(found.motion.poses) == expected
    assert found.motion.frame_time_s == pytest.approx(1 / expected_hertz)
    assert found.warnings == ()
    assert found.source == "BVH with the names of Mixamo"
    assert found.up == "y"


def test_a_stretch_of_a_clip_is_what_was_asked_for(body):
    clip = clip_of(body, 90, 1 / 30)
    found = motion_of_clip(read_motion(clip, start_s=1.0), body.rig, duration_s=0.5).motion
    whole = motion_of_clip(read_motion(clip), body.rig).motion
    assert len(found.poses) == 15
    np.testing.assert_allclose(found.poses[:, 1:], whole.poses[30:45, 1:], atol=1e-9)


def test_a_clip_that_is_too_long_is_cut_and_says_so(body):
    found = motion_of_clip(read_motion(clip_of(body, MOST_FRAMES + 30, 1 / 30)), body.rig)
    assert len(found.motion.poses) == MOST_FRAMES
    (warning,) = found.warnings
    assert warning.code == "clip-cut"
    assert "12.00 of 13.00 s" in warning.reason


def test_what_is_odd_in_a_file_is_told_with_what_is_in_doubt(body):
    content = clip_of(body, 4, 1 / 30).replace(b"Frames: ", b"Frames:")
    found = motion_of_clip(read_motion(content), body.rig, up="-z")
    assert [warning.code for warning in found.warnings] == ["bvh-irregular"]
    assert found.up == "-z"
    told = {part: name for part, name in MIXAMO.items() if part not in ("neck", "head")}
    own = motion_of_clip(read_motion(content, named=told), body.rig)
    assert own.source == "BVH with the names of the request"


def walked(body, roots=None):
    """One stride, as of a file that says where its hips are if these are given."""
    stride = stride_of(body.rig)
    motion = motion_of_cycle(stride, body.rig, frames=stride.frames)
    if roots is not None:
        motion = replace(motion, roots=roots)
    up = None if roots is None else "y"
    return ChosenMotion(motion=motion, source="a stride", up=up, warnings=())


@pytest.fixture(scope="module")
def person(body):
    return FittedPerson(
        gender=Gender.MALE,
        model_checksum=str(body.model.header["checksum"]),
        body=BodyParameters(
            pose=np.zeros((17, 3)), translation=np.array([0.0, 0.0, 3.0]), shape=body.shape
        ),
        camera=CAMERA,
        light=POINT_LIGHT,
        reflectance=reflectance_of(body.model),
        albedo_rgb=None,
    )


@pytest.fixture(scope="module")
def animation(body, person):
    return animate(person, body.evaluator, walked(body))


@pytest.mark.parametrize("pose", ["a_pose", "t_pose"])
def test_a_rig_is_the_exact_body_in_its_pose_and_says_how_far_it_bends(body, person, pose):
    made = rigged(person, body.evaluator, pose)
    assert set(made.files) == {"body_skinned.glb"}
    glb = read_glb(made.files["body_skinned.glb"])
    exact = body.vertices(named_pose(body.rig, pose))
    exact[:, 1] -= exact[:, 1].min()
    np.testing.assert_allclose(glb.attribute("POSITION"), exact, atol=1e-5)
    assert "animations" not in glb.document
    extras = glb.document["scenes"][0]["extras"]
    assert extras["mean_error_mm"] == made.skin_mean_error_mm < 6.0
    turns = [node.get("rotation") for node in glb.document["nodes"][1:]]
    if pose == "t_pose":
        np.testing.assert_allclose(turns, [[0.0, 0.0, 0.0, 1.0]] * 19, atol=1e-8)


@pytest.mark.parametrize("names", BoneNames)
def test_a_motion_written_as_bvh_is_read_again_by_every_program_s_names(body, moving, names):
    skeleton = skeleton_of(body.evaluator, body.shape, body.rig, names)
    assert set(skeleton.names) == set(BONE_NAMES[names].values())
    source = read_motion(bvh_of_motion(moving, skeleton, body.model))
    found = motion_of_clip(source, body.rig)
    assert source.naming.lower().startswith(names)
    apart = found.motion.poses - moving.motion.poses
    assert np.abs(apart[:, [0, 12]]).max() < 0.06
    assert (found.up, found.warnings) == ("y", ())


def test_a_file_that_goes_elsewhere_than_its_feet_is_told_with_both_ways(body):
    on_the_spot = walked(body).motion.roots
    made = grounded(moving_body(body.evaluator, body.shape, walked(body).motion), body.model)
    to_and_fro = 0.4 * np.sin(np.linspace(0.0, np.pi, len(on_the_spot)))[:, None] * [1, 0, 0]
    assert way_warnings(walked(body), made) == ()
    assert way_warnings(walked(body, made.roots), made) == ()
    assert way_warnings(walked(body, made.roots * [1.0, 1.0, 0.95]), made) == ()
    for roots, length in ((on_the_spot, "0.00"), (to_and_fro, "0.80")):
        (warning,) = way_warnings(walked(body, roots), made)
        apart = np.linalg.norm(made.roots[-1] - made.roots[0])
        assert warning.code == "way-differs"
        assert f"its way is {length} m" in warning.reason
        assert f"they end {apart:.2f} m apart" in warning.reason


def test_the_way_of_a_file_is_kept_where_feet_need_to_slide_but_slowly(body):
    motion = walked(body).motion
    by_its_feet = grounded(moving_body(body.evaluator, body.shape, motion), body.model)
    planned = by_its_feet.roots * [1.0, 1.0, 0.97]
    moving = moving_body(body.evaluator, body.shape, replace(motion, roots=planned))
    made = grounded(moving, body.model)
    ends = [each[-1] - each[0] for each in (made.roots, planned, by_its_feet.roots)]
    np.testing.assert_allclose(ends[0][[0, 2]], ends[1][[0, 2]], atol=1e-9)
    assert np.linalg.norm(ends[1] - ends[2]) > 0.03
    slower = SLOWEST_M_PER_S * motion.frame_time_s
    assert sliding_m(made, body.model) < sliding_m(by_its_feet, body.model) + slower


def test_an_animation_states_in_its_files_what_it_reports(animation):
    assert set(animation.files) == {
        "body_animated.glb",
        "body_skinned.glb",
        "motion.bvh",
        "animation.webp",
    }
    morphed, skinned = (
        read_glb(animation.files[name]).document["scenes"][0]["extras"]
        for name in ("body_animated.glb", "body_skinned.glb")
    )
    assert morphed["morph_targets"] == animation.morph_targets
    assert morphed["largest_error_mm"] == animation.morph_largest_error_mm
    assert skinned["largest_error_mm"] == animation.skin_largest_error_mm
    assert animation.morph_largest_error_mm < animation.skin_largest_error_mm
    assert animation.sliding_mm < 2.0
    assert animation.travelled_m > 0.9


def test_an_animation_keeps_the_skins_colours(body, animation):
    for name in ("body_animated.glb", "body_skinned.glb"):
        glb = read_glb(animation.files[name])
        np.testing.assert_allclose(
            glb.attribute("_ALBEDO").ravel(), reflectance_of(body.model).albedo, atol=1e-6
        )


def test_the_film_moves_and_plays_as_long_as_the_motion(animation):
    film = Image.open(io.BytesIO(animation.files["animation.webp"]))
    pictures = []
    seconds = 0.0
    for frame in range(film.n_frames):
        film.seek(frame)
        pictures.append(np.asarray(film.convert("L"), dtype=float))
        seconds += film.info["duration"] / 1e3
    assert film.n_frames > 10
    assert seconds == pytest.approx(animation.frames * animation.frame_time_s, rel=0.1)
    assert all(np.abs(b - a).max() > 50 for a, b in itertools.pairwise(pictures))


def test_documents_are_json_of_finite_numbers(animation):
    for name in ("body_animated.glb", "body_skinned.glb"):
        json.dumps(read_glb(animation.files[name]).document, allow_nan=False)
