import numpy as np
import pytest

from fitter.measurement.plane_cut import Plane, plane_section, whole_mesh
from fitter.training.makehuman.body_space import average_traits, source_vertices
from fitter.training.makehuman.meshes import with_knee_rings
from tests.unit.measurement.plain_hull import in_plane
from tests.unit.training.makehuman_data import base_mesh, body_space, needs_makehuman

GROUPS = {
    "joint-l-knee": np.array([0]),
    "joint-l-upper-leg": np.array([1]),
    "joint-l-ankle": np.array([2]),
}


def pillar():
    """Three helper points and a leg of rings 1 cm apart, denser in front than behind."""
    front = np.linspace(0.0, np.pi, 60)
    behind = np.linspace(np.pi, 2.0 * np.pi, 20)[1:-1]
    angle = np.concatenate([front, behind])
    circle = np.stack([0.1 + 0.06 * np.cos(angle), 0 * angle, 0.06 * np.sin(angle)], axis=1)
    rings = [circle + [0.0, 0.01 * level, 0.0] for level in range(-20, 21)]
    helpers = np.array([[0.1, 0.003, 0.004], [0.1, 0.4, 0.0], [0.1, -0.4, 0.0]])
    return np.concatenate([helpers, *rings])


def skin_mean(vertices):
    return vertices[3:].mean(axis=0)


def test_the_mean_of_a_ring_is_the_middle_of_the_leg_however_dense_its_mesh():
    vertices = pillar()
    skin = np.arange(3, len(vertices))
    groups = with_knee_rings(GROUPS, vertices, skin, np.arange(len(vertices)))
    ring = vertices[groups["joint-l-knee"]]
    np.testing.assert_allclose(ring[:, 1], 0.0, atol=1e-12)
    np.testing.assert_allclose(ring.mean(axis=0), [0.1, 0.0, 0.0], atol=0.003)
    assert skin_mean(vertices)[2] > 0.015


def test_the_right_ring_is_the_left_ones_mirror_and_other_groups_stay():
    vertices = pillar()
    skin, mirror = np.arange(3, len(vertices)), np.arange(len(vertices))[::-1]
    groups = with_knee_rings(GROUPS, vertices, skin, mirror)
    np.testing.assert_array_equal(groups["joint-r-knee"], mirror[groups["joint-l-knee"]])
    assert groups["joint-l-ankle"] == [2]


@needs_makehuman
@pytest.mark.parametrize(("gender", "height"), [("female", 0.2), ("male", 0.8)])
def test_short_and_tall_peoples_knees_are_in_the_middle_of_their_legs(gender: str, height: float):
    space, base = body_space(gender), base_mesh()
    parameters = space.neutral.copy()
    parameters[space.parameter_names.index("height")] = height
    source = source_vertices(space, average_traits(), parameters)
    hip, knee, ankle = (
        source[base.groups[f"joint-l-{name}"]].mean(axis=0)
        for name in ("upper-leg", "knee", "ankle")
    )
    plane = Plane(point=knee, normal=(ankle - hip) / np.linalg.norm(ankle - hip))
    lines = plane_section(base.body(source), whole_mesh(base.triangles), plane)
    leg = in_plane(
        min(lines, key=lambda line: np.linalg.norm(line.points.mean(0) - knee)).points, plane
    )
    low, high = leg.min(axis=0), leg.max(axis=0)
    assert np.abs(low + high).max() / 2 < 0.008
    assert 0.45 < (hip - knee)[1] / (hip - ankle)[1] < 0.56
