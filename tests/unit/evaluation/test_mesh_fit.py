import numpy as np
import pytest

from fitter.body.model import regress
from fitter.fits.prepared_model import prepared_model
from fitter.parameters import BodyParameters
from fitter.vocabulary.choices import Gender
from tests.evaluation.closest_points import closest_pairs, distances_m, surface_of
from tests.evaluation.joint_figures import distance_errors_m, joint_error_mm, part_of_joint
from tests.evaluation.mesh_fit import PosedMesh, fit_mesh
from tests.evaluation.refinement import vertex_normals


@pytest.mark.slow
def test_a_body_of_our_own_is_found_again_on_a_mesh_numbered_otherwise():
    model = prepared_model(Gender.FEMALE).operators.model
    evaluator = prepared_model(Gender.FEMALE).operators.evaluator
    rng = np.random.default_rng(4)
    true = BodyParameters(
        pose=model.canonical_pose + rng.normal(scale=0.06, size=model.canonical_pose.shape),
        translation=np.array([0.1, -0.05, 3.2]),
        shape=rng.normal(size=len(model.shape_basis)),
    )
    vertices = evaluator.vertices(true)
    joints = regress(model.joint_regressor, vertices)
    joints[0] = np.nan
    order = rng.permutation(len(vertices))
    renumbered = np.argsort(order)[model.triangles]
    mesh = PosedMesh(
        gender=Gender.FEMALE, vertices=vertices[order], triangles=renumbered, joints=joints
    )
    found = fit_mesh(mesh)
    assert np.linalg.norm(found.vertices - vertices, axis=1).mean() < 0.002
    assert found.trunk_mm < 1.0
    few = fit_mesh(mesh, coefficients=5)
    assert not few.parameters.shape[5:].any()
    assert few.trunk_mm > found.trunk_mm


def _sphere(radius_m: float) -> tuple[np.ndarray, np.ndarray]:
    steps, around = 24, 48
    polar, azimuth = np.meshgrid(
        np.pi * (np.arange(steps) + 0.5) / steps, 2.0 * np.pi * np.arange(around) / around,
        indexing="ij",
    )  # fmt: skip
    points = np.stack(
        [np.sin(polar) * np.cos(azimuth), np.sin(polar) * np.sin(azimuth), np.cos(polar)], axis=2
    )
    number = np.arange(steps * around).reshape(steps, around)
    a, b = number[:-1], number[1:]
    c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
    triangles = np.concatenate([np.stack(t, axis=2).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    return radius_m * points.reshape(-1, 3), triangles


def test_the_normals_of_a_sphere_point_outward():
    points, triangles = _sphere(1.0)
    assert (np.einsum("ij,ij->i", vertex_normals(points, triangles), points) > 0.9).all()


def test_distances_from_a_sphere_are_differences_of_radii():
    points, triangles = _sphere(0.2)
    outer, _ = _sphere(0.21)
    assert distances_m(outer, surface_of(points, triangles)) == pytest.approx(0.01, abs=5e-4)


def test_pairs_of_two_spheres_stand_off_by_the_difference_of_radii():
    points, triangles = _sphere(0.2)
    mesh = surface_of(points, triangles)
    (to_mesh, to_ours), energy = closest_pairs(1.05 * points, triangles, mesh)
    assert to_mesh.away_m == pytest.approx(0.01, abs=5e-4)
    assert to_ours.away_m == pytest.approx(0.01, abs=5e-4)
    _, nearer = closest_pairs(1.02 * points, triangles, mesh)
    assert 0.0 < nearer < energy


def test_what_faces_another_way_is_no_pair():
    points, triangles = _sphere(0.2)
    (to_mesh, to_ours), _ = closest_pairs(points, triangles[:, ::-1], surface_of(points, triangles))
    assert len(to_mesh.ours) == len(to_ours.ours) == 0


def _joints() -> np.ndarray:
    return np.random.default_rng(0).normal(size=(17, 3))


def test_joints_are_compared_about_the_hips_where_the_truth_has_no_root():
    found = _joints()
    true = found + [0.3, 0.0, 0.0]
    true[0] = np.nan
    assert joint_error_mm(found, true) == pytest.approx(0.0, abs=1e-9)
    true[part_of_joint("left_wrist")] += [0.0, 0.016, 0.0]
    assert joint_error_mm(found, true) == pytest.approx(1.0)


def test_distances_from_the_camera_are_those_of_a_pairs_middle():
    true = _joints()
    found = true.copy()
    found[part_of_joint("left_knee"), 2] += 0.3
    found[part_of_joint("right_knee"), 2] -= 0.1
    assert distance_errors_m(found, true) == pytest.approx(
        {"hips": 0.0, "shoulders": 0.0, "knees": 0.1, "ankles": 0.0}
    )
