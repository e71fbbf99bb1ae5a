"""GLB files of fitted bodies and of plain ones."""

import io
from dataclasses import replace

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

from fitter.export.glb import BinaryChunk, Frame
from fitter.export.gltf import body_canonical_glb, body_posed_glb, plain_glb, quaternion_from_z_to
from fitter.export.gltf_mesh import LIGHTEST, add_body_mesh
from fitter.parameters import CameraTilt
from fitter.person.upright import upright_frame
from fitter.vocabulary.outcomes import StanceKind
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.glb_reader import read_glb
from tests.unit.export.results import CAMERA, POINT_LIGHT, SUN, reflectance_of, result_of

TO_GLTF = np.array([1.0, -1.0, -1.0])


@pytest.fixture(scope="module")
def model():
    return bar_model()


@pytest.fixture(scope="module")
def result(model):
    return result_of(model)


@pytest.fixture(scope="module")
def posed(result, model):
    return read_glb(body_posed_glb(result.found, model))


def light_of(glb):
    (light,) = glb.document["extensions"]["KHR_lights_punctual"]["lights"]
    (node,) = [n for n in glb.document["nodes"] if n["name"] == "light"]
    return light, node


def test_the_light_is_described_and_not_switched_on(posed):
    assert all("extensions" not in node for node in posed.document["nodes"])
    assert light_of(posed)[1]["extras"] == {"light": 0}


def test_another_reader_finds_the_same_vertices_and_triangles_in_the_same_order(result, model):
    scene = trimesh.load(
        io.BytesIO(body_posed_glb(result.found, model)), file_type="glb", process=False
    )
    (mesh,) = scene.geometry.values()
    np.testing.assert_allclose(mesh.vertices, result.found.posed_vertices * TO_GLTF, atol=1e-6)
    np.testing.assert_array_equal(mesh.faces, model.triangles)
    assert mesh.volume > 0.0, "turning the axes has not turned the surface inside out"


def test_where_the_tilt_is_known_all_of_the_file_is_set_upright(result, model, posed):
    tilt = CameraTilt(
        pitch=-0.2, roll=0.05, covariance=np.eye(2), stances={StanceKind.STANDING: 1.0}
    )
    person = replace(result.person, tilt=tilt)
    content = body_posed_glb(replace(result.found, person=person), model)
    file = read_glb(content)
    np.testing.assert_array_equal(file.attribute("POSITION"), posed.attribute("POSITION"))
    scene = trimesh.load(io.BytesIO(content), file_type="glb", process=False)
    vertices = result.found.posed_vertices
    world = upright_frame(tilt, vertices=vertices, root=result.person.body.translation)
    np.testing.assert_allclose(scene.to_mesh().vertices, world.points(vertices), atol=1e-6)
    assert scene.to_mesh().bounds[0, 1] == pytest.approx(0.0, abs=1e-6)
    camera = scene.graph.get("upright")[0]  # in which it is the identity
    np.testing.assert_allclose(camera[:3, 3], world.translation, atol=1e-9)
    np.testing.assert_allclose(-camera[:3, 2], world.rotation @ np.array([0, 0, 1.0]), atol=1e-9)
    *placed, upright = file.document["nodes"]
    assert upright["children"] == list(range(len(placed)))
    assert "matrix" not in upright
    assert "against gravity" in file.document["scenes"][0]["extras"]["frame"]
    assert "not known" in posed.document["scenes"][0]["extras"]["frame"]


def test_the_gltf_camera_projects_the_file_to_the_same_pixels(result, posed):
    camera = posed.document["cameras"][0]
    assert "matrix" not in posed.document["nodes"][1]
    half_height = np.tan(camera["perspective"]["yfov"] / 2)
    half_width = half_height * camera["perspective"]["aspectRatio"]
    p = posed.attribute("POSITION").astype(float)
    device = np.stack([p[:, 0] / half_width, p[:, 1] / half_height], 1) / -p[:, 2:]
    size = np.array([CAMERA.width, CAMERA.height])
    pixels = (device * [1, -1] + 1) / 2 * size
    # glTF knows no principal point: the extras restore it.
    extras = camera["extras"]
    pixels += np.array([extras["cx_px"], extras["cy_px"]]) - size / 2
    np.testing.assert_allclose(pixels, CAMERA.project(result.found.posed_vertices), atol=1e-3)
    assert extras["fx_px"] == extras["fy_px"] == CAMERA.focal_length_px
    assert (extras["width_px"], extras["height_px"]) == (CAMERA.width, CAMERA.height)


def test_a_point_light_stands_and_shines_as_in_equation_1(result, posed):
    light, node = light_of(posed)
    position = np.array(node["translation"]) * TO_GLTF
    offset = position - result.person.body.translation
    assert np.linalg.norm(offset) == pytest.approx(POINT_LIGHT.distance)
    assert offset[0] > 0, "a positive azimuth comes from the right of the picture"
    assert offset[1] < 0, "a positive elevation comes from above"
    assert offset[2] < 0, "the light is on the camera's side"
    # Illuminance at the body's centre, divided by pi, is l = 1.
    l_at_centre = light["intensity"] / POINT_LIGHT.distance**2 / np.pi
    assert l_at_centre == pytest.approx(light["extras"]["colour_scale"])
    assert light["extras"]["ambient"] == result.person.reflectance.ambient
    assert light["extras"]["specular_exponent"] == result.person.reflectance.specular_exponent


def test_a_directional_light_shines_along_its_nodes_minus_z(model):
    glb = read_glb(body_posed_glb(result_of(model, light=SUN).found, model))
    light, node = light_of(glb)
    travels = Rotation.from_quat(node["rotation"]).apply([0.0, 0.0, -1.0]) * TO_GLTF
    toward = np.array(
        [
            np.cos(SUN.elevation) * np.sin(SUN.azimuth),
            -np.sin(SUN.elevation),
            -np.cos(SUN.elevation) * np.cos(SUN.azimuth),
        ]
    )
    np.testing.assert_allclose(travels, -toward, atol=1e-12)
    assert light["type"] == "directional"
    assert light["intensity"] == pytest.approx(np.pi * light["extras"]["colour_scale"])


@pytest.mark.parametrize("direction", [(0, 0, 1), (0, 0, -1), (1, 0, 0), (0.48, -0.6, -0.64)])
def test_the_shortest_rotation_takes_z_to_the_direction(direction):
    turned = Rotation.from_quat(quaternion_from_z_to(np.array(direction, dtype=np.float64))).apply(
        [0, 0, 1]
    )
    np.testing.assert_allclose(turned, direction, atol=1e-12)


def test_reflectance_is_kept_per_vertex(result, posed):
    np.testing.assert_allclose(
        posed.attribute("_ALBEDO"), result.person.reflectance.albedo, rtol=1e-6
    )
    np.testing.assert_allclose(
        posed.attribute("_SPECULARITY"), result.person.reflectance.specularity, rtol=1e-6
    )
    grey = np.repeat(result.person.reflectance.albedo[:, None], 3, axis=1)
    scale = light_of(posed)[0]["extras"]["colour_scale"]
    np.testing.assert_allclose(scale * posed.attribute("COLOR_0"), grey, rtol=1e-6)


def test_colours_are_used_where_they_were_estimated(model):
    m = len(model.mean_vertices)
    colours = np.random.default_rng(3).uniform(0.1, 0.9, size=(m, 3))
    glb = read_glb(body_posed_glb(result_of(model, albedo_rgb=colours).found, model))
    scale = light_of(glb)[0]["extras"]["colour_scale"]
    np.testing.assert_allclose(scale * glb.attribute("COLOR_0"), colours, rtol=1e-6)


def test_hardly_any_colour_is_lighter_than_surfaces_of_people_are(model):
    m = len(model.mean_vertices)
    for brightest in (0.5, 1.0, 3.0):
        colours = np.random.default_rng(3).uniform(0.1, brightest, size=(m, 3))
        glb = read_glb(body_posed_glb(result_of(model, albedo_rgb=colours).found, model))
        shown = glb.attribute("COLOR_0")
        assert np.percentile(shown, 99.0) <= LIGHTEST + 1e-6
        assert np.percentile(shown, 99.0) >= min(LIGHTEST, np.percentile(colours, 99.0)) - 1e-6


def test_albedo_above_one_is_a_darker_colour_under_a_stronger_light(model):
    bright = result_of(model, reflectance=reflectance_of(model, brightest=2.0))
    glb = read_glb(body_posed_glb(bright.found, model))
    light, _ = light_of(glb)
    l_at_centre = light["intensity"] / POINT_LIGHT.distance**2 / np.pi
    assert l_at_centre > 1.5
    colours = glb.attribute("COLOR_0")[:, 0]
    assert colours.max() <= 1.0
    below = bright.person.reflectance.albedo < l_at_centre
    np.testing.assert_allclose(
        (colours * l_at_centre)[below], bright.person.reflectance.albedo[below], rtol=1e-6
    )


def test_the_highlight_is_as_high_as_blinn_phongs(result, posed):
    """GGX at the mirror direction with normal incidence, F0 D V with V = 1/4."""
    (material,) = posed.document["materials"]
    alpha = material["pbrMetallicRoughness"]["roughnessFactor"] ** 2
    f0 = 0.04 * material["extensions"]["KHR_materials_specular"]["specularColorFactor"][0]
    light, _ = light_of(posed)
    illuminance = light["intensity"] / POINT_LIGHT.distance**2
    peak = illuminance * f0 / (np.pi * alpha**2) / 4.0
    assert peak == pytest.approx(result.person.reflectance.specularity.mean())
    assert material["pbrMetallicRoughness"]["metallicFactor"] == 0.0


def test_without_shading_there_is_neither_light_nor_reflectance(model):
    glb = read_glb(body_posed_glb(result_of(model, light=None).found, model))
    assert set(glb.attributes) == {"POSITION", "NORMAL"}
    assert "extensions" not in glb.document
    assert "extensionsUsed" not in glb.document
    assert [node["name"] for node in glb.document["nodes"]] == ["body", "camera"]


def test_the_canonical_body_stands_on_the_floor(result, model):
    glb = read_glb(body_canonical_glb(result, model))
    p = glb.attribute("POSITION")
    assert p[:, 1].min() == 0.0
    offset = p - result.canonical_vertices
    np.testing.assert_allclose(offset - offset[0], 0.0, atol=1e-6)
    albedo = result.person.reflectance.albedo
    np.testing.assert_allclose(glb.attribute("_ALBEDO"), albedo, rtol=1e-6)
    assert "cameras" not in glb.document


def test_normals_are_unit_and_point_outward(posed):
    normals = posed.attribute("NORMAL")
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-6)
    p = posed.attribute("POSITION")
    assert (np.einsum("mi,mi->m", normals, p - p.mean(axis=0)) > 0).all()


def test_buffers_are_aligned_and_bounds_are_exact(posed):
    for view in posed.document["bufferViews"]:
        assert view["byteOffset"] % 4 == 0
    end = max(v["byteOffset"] + v["byteLength"] for v in posed.document["bufferViews"])
    length = posed.document["buffers"][0]["byteLength"]
    assert end <= length == len(posed.binary) < end + 4
    position = posed.document["accessors"][posed.attributes["POSITION"]]
    stored = posed.attribute("POSITION")
    assert position["min"] == stored.min(axis=0).astype(float).tolist()
    assert position["max"] == stored.max(axis=0).astype(float).tolist()


def test_provenance_is_in_asset_and_scene(model):
    header = {"checksum": "abc", "licences": {"shape data": "CC0-1.0"}, "sources": ["survey"]}
    known = replace(model, header=header)
    document = read_glb(body_canonical_glb(result_of(known), known)).document
    for extras in (document["asset"]["extras"], document["scenes"][0]["extras"]):
        assert extras["generator"].startswith("Maquette")
        assert (extras["gender"], extras["height_m"], extras["cues"]) == ("female", 1.3, "SES")
        assert extras["body_model"]["licences"] == header["licences"]
        assert extras["body_model"]["checksum"] == "abc"


def written():
    model = bar_model()
    content = plain_glb(
        model.mean_vertices, model, name="body", frame=Frame.STANDING, extras={"height_m": 1.7}
    )
    return model, read_glb(content)


def test_vertices_keep_their_order_and_stand_on_the_ground():
    model, glb = written()
    positions = glb.attribute("POSITION")
    lowest = model.mean_vertices[:, 1].min()
    assert np.abs(positions - (model.mean_vertices - [0.0, lowest, 0.0])).max() < 1e-6
    indices = glb.accessor(glb.document["meshes"][0]["primitives"][0]["indices"])
    assert np.array_equal(indices.reshape(-1, 3), model.triangles)


@pytest.mark.parametrize(
    ("vertices", "component"), [(65_534, 5123), (65_535, 5125), (70_000, 5125)]
)
def test_as_many_vertices_as_sixteen_bits_count_have_wider_indices(vertices, component):
    """The largest number of each kind is none that an index may have."""
    triangles = np.arange(vertices - 2)[:, None] + np.arange(3)
    places = np.random.default_rng(0).normal(size=(vertices, 3))
    binary = BinaryChunk()
    primitive = add_body_mesh(
        {}, binary, vertices=places, triangles=triangles, reflectance=None, albedo_rgb=None
    )
    accessor = binary.accessors[primitive["indices"]]
    assert accessor["componentType"] == component
    view = binary.buffer_views[accessor["bufferView"]]
    kept = np.frombuffer(
        binary.content(),
        {5123: "<u2", 5125: "<u4"}[component],
        accessor["count"],
        view["byteOffset"],
    )
    np.testing.assert_array_equal(kept.reshape(-1, 3), triangles)
