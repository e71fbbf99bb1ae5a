import numpy as np
import pytest
import trimesh

from tests.evaluation.trunk_sections import LEVELS, TrunkSections, trunk_sections


def _cylinder(breadth_m: float, depth_m: float, height_m: float, x_m: float) -> trimesh.Trimesh:
    """An upright elliptic cylinder of 360 sides that stands on the floor."""
    mesh = trimesh.creation.cylinder(radius=0.5, height=height_m, sections=360)
    z_up = mesh.vertices
    mesh.vertices = np.stack(
        [x_m + breadth_m * z_up[:, 0], z_up[:, 2] + 0.5 * height_m, -depth_m * z_up[:, 1]], axis=1
    )
    return mesh


def _sections(*meshes: trimesh.Trimesh) -> TrunkSections:
    first = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return trunk_sections(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + start for mesh, start in zip(meshes, first, strict=False)]),
    )


def test_a_cylinder_is_as_broad_and_deep_everywhere():
    sections = _sections(_cylinder(0.32, 0.2, 1.7, 0.0))
    assert sections.breadth_m == pytest.approx(np.full(len(LEVELS), 0.32), abs=1e-4)
    assert sections.depth_m == pytest.approx(np.full(len(LEVELS), 0.2), abs=1e-4)


def test_arms_beside_the_trunk_are_left_out():
    arms = [_cylinder(0.1, 0.5, 1.2, side * 0.3) for side in (-1.0, 1.0)]
    sections = _sections(_cylinder(0.32, 0.2, 1.7, 0.0), *arms)
    assert sections.breadth_m == pytest.approx(np.full(len(LEVELS), 0.32), abs=1e-4)
    assert sections.depth_m == pytest.approx(np.full(len(LEVELS), 0.2), abs=1e-4)


def test_both_thighs_belong_to_the_trunk():
    thighs = [_cylinder(0.15, 0.2, 1.7, side * 0.09) for side in (-1.0, 1.0)]
    assert _sections(*thighs).breadth_m == pytest.approx(np.full(len(LEVELS), 0.33), abs=1e-4)


def test_a_cone_narrows_by_height():
    cone = trimesh.creation.cone(radius=0.4, height=2.0, sections=360)
    z_up = np.array(cone.vertices)
    sections = trunk_sections(z_up[:, [0, 2, 1]] * [1.0, 1.0, -1.0], np.array(cone.faces))
    assert sections.breadth_m == pytest.approx(0.8 * (1.0 - np.array(LEVELS)), abs=1e-4)
