import numpy as np

from fitter.export.glb import Frame
from fitter.export.gltf import plain_glb
from fitter.parameters import Reflectance
from tests.unit.body.synthetic_model import bar_model
from tests.unit.export.glb_reader import read_glb


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


def test_normals_are_of_unit_length_and_point_outward():
    model, glb = written()
    normals = glb.attribute("NORMAL")
    assert np.abs(np.linalg.norm(normals, axis=1) - 1.0).max() < 1e-6
    outward = model.mean_vertices - model.mean_vertices.mean(axis=0)
    assert np.mean(np.einsum("md,md->m", normals, outward) > 0.0) > 0.9


def test_provenance_and_extras_are_in_the_asset_and_in_the_scene():
    model, glb = written()
    for extras in (glb.document["asset"]["extras"], glb.document["scenes"][0]["extras"]):
        assert extras["height_m"] == 1.7
        assert extras["gender"] == model.gender
        assert extras["frame"] == Frame.STANDING


def test_the_same_body_gives_the_same_bytes():
    model = bar_model()
    first, second = (
        plain_glb(model.mean_vertices, model, name="body", frame=Frame.STANDING, extras={})
        for _ in range(2)
    )
    assert first == second


def test_the_colours_of_the_skin_are_given_where_they_are_known():
    model = bar_model()
    count = len(model.mean_vertices)
    skin = Reflectance(
        ambient=0.1,
        specular_exponent=20.0,
        albedo=np.linspace(0.2, 0.6, count),
        specularity=np.full(count, 0.1),
    )
    glb = read_glb(
        plain_glb(
            model.mean_vertices,
            model,
            name="body",
            frame=Frame.STANDING,
            extras={},
            reflectance=skin,
        )
    )
    assert np.abs(glb.attribute("_ALBEDO").ravel() - skin.albedo).max() < 1e-6
    plain = read_glb(
        plain_glb(model.mean_vertices, model, name="body", frame=Frame.STANDING, extras={})
    )
    assert "COLOR_0" not in plain.document["meshes"][0]["primitives"][0]["attributes"]
