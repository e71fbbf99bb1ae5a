import numpy as np
import pytest

from fitter.render.reflectance import light_position
from tests.accuracy.cases import CASES, PEOPLE
from tests.accuracy.clicks import CLICK_DEVIATION_PX, noisy_clicks, rendering, true_points
from tests.accuracy.people import load_person, rig_of_people
from tests.accuracy.staging import Staged, lamp_place, root_joint, stage
from tests.accuracy.truth import true_body, true_joints, true_light
from tests.unit.training.makehuman_data import needs_makehuman

pytestmark = [pytest.mark.slow, needs_makehuman]


def _staged(name: str) -> Staged:
    case = CASES[name]
    return stage(load_person(PEOPLE[case.person]), case)


@pytest.fixture(scope="module")
def demo() -> Staged:
    return _staged("demo")


def test_curled_fingers_move_hands_alone_and_towards_the_palm(demo):
    mesh = rig_of_people()
    curled = demo.source_vertices(mesh.surface.body_vertex_ids)
    moved = np.linalg.norm(curled - demo.body, axis=1) > 1e-6
    fingers = np.array([name.startswith("finger") for name in mesh.rig.bone_names])
    assert not moved[(mesh.skin @ fingers) == 0.0].any()
    wrist = demo.bones["wrist.L"]
    knuckles, tips = demo.bones["finger3-1.L"], demo.bones["finger3-3.L"]
    thumb = demo.bones["finger1-3.L"] - knuckles
    palm = thumb - (thumb @ (tips - wrist)) * (tips - wrist) / ((tips - wrist) @ (tips - wrist))
    left_tips = moved & (np.linalg.norm(demo.body - tips, axis=1) < 0.03)
    assert ((curled - demo.body)[left_tips].mean(axis=0) @ palm) > 0.0


def test_the_lamp_is_where_the_truth_says_in_the_fitters_terms(demo):
    centre = demo.in_camera(root_joint(demo))
    np.testing.assert_allclose(
        light_position(true_light(demo), centre),
        demo.in_camera(lamp_place(demo, demo.case.lighting.lamp)),
        atol=1e-9,
    )


def test_the_models_joints_on_the_true_body_are_the_rigs_joints(demo):
    found = true_joints(demo)[0]
    # People turn about cubes in the bone, the model about skin: a centimetre lies between.
    np.testing.assert_allclose(found, demo.in_camera(root_joint(demo)), atol=0.015)


def test_a_person_is_as_tall_and_heavy_as_their_mesh(demo):
    truth = true_body(demo.person)
    rest = rig_of_people().surface.body(demo.person.source_vertices)
    assert truth.measurements["stature"] / 100.0 == pytest.approx(np.ptp(rest[:, 1]), abs=0.03)
    a, b, c = (rest[rig_of_people().surface.triangles[:, k]] for k in range(3))
    volume = np.einsum("fx,fx->", a, np.cross(b, c)) / 6.0
    assert truth.measurements["weight"] == pytest.approx(1000.0 * volume, rel=0.02)


def test_clicks_scatter_about_the_true_points_by_their_deviation(demo):
    seen = rendering(demo)
    true = {name: demo.camera.project(point) for name, point in true_points(demo).items()}
    offsets = [
        (click["x"] - true[name][0], click["y"] - true[name][1])
        for seed in range(20)
        for name, click in noisy_clicks(demo, seen, np.random.default_rng(seed)).items()
    ]
    assert np.std(offsets) == pytest.approx(CLICK_DEVIATION_PX, rel=0.1)
    assert abs(np.mean(offsets)) < 0.3


def test_an_ear_on_the_far_side_of_the_head_is_not_clicked():
    turned = _staged("woman_old_middling_turned")
    clicks = noisy_clicks(turned, rendering(turned), np.random.default_rng(0))
    assert "left_ear" not in clicks or "right_ear" not in clicks
