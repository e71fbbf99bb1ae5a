"""USDZ files read by Pixar's own library, and held to its rules and to those of ARKit."""

import io
import zipfile

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdShade, UsdValidation

from fitter.export.formats import converted
from fitter.export.formats.usdz import ALIGNMENT, usdz_archive
from tests.unit.export.formats.bodies import KNOWN, MICROMETRE, coloured, plain, textured

ARKIT_PRIMS = {"Xform", "Mesh", "Material", "Shader"}
"""Of those ARKit shows, the ones needed here."""

ARKIT_SHADERS = {"UsdPreviewSurface", "UsdUVTexture", "UsdPrimvarReader_float2"}


@pytest.fixture
def stages(tmp_path):
    """Opens files, and keeps them open while the test lasts."""
    kept = []

    def opened(content: bytes) -> Usd.Stage:
        path = tmp_path / f"{len(kept)}.usdz"
        path.write_bytes(content)
        kept.append(Usd.Stage.Open(str(path)))
        return kept[-1]

    return opened


def mesh_of(stage) -> UsdGeom.Mesh:
    (mesh,) = (prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
    return UsdGeom.Mesh(mesh)


def complaints(stage) -> list[str]:
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    return [
        each.GetMessage() for each in UsdValidation.ValidationContext(validators).Validate(stage)
    ]


@pytest.mark.parametrize("name", KNOWN)
def test_vertices_and_triangles_are_the_models_in_its_order_in_metres_y_up(name, stages):
    known = KNOWN[name]()
    stage = stages(converted(known.glb, "usdz"))
    assert UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    mesh = mesh_of(stage)
    points = np.array(mesh.GetPointsAttr().Get())
    assert np.abs(points - known.vertices).max() < MICROMETRE
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
    assert np.array_equal(corners, known.triangles)
    assert set(mesh.GetFaceVertexCountsAttr().Get()) == {3}
    box = UsdGeom.BBoxCache(Usd.TimeCode.Default(), [UsdGeom.Tokens.default_])
    whole = box.ComputeWorldBound(stage.GetDefaultPrim()).ComputeAlignedRange()
    assert np.abs(np.array(whole.GetMin()) - known.vertices.min(axis=0)).max() < MICROMETRE
    assert np.abs(np.array(whole.GetMax()) - known.vertices.max(axis=0)).max() < MICROMETRE


@pytest.mark.parametrize("name", KNOWN)
def test_pixars_validators_have_nothing_to_say(name, stages):
    assert complaints(stages(converted(KNOWN[name]().glb, "usdz"))) == []


def test_pixars_validators_are_awake(stages, tmp_path):
    with zipfile.ZipFile(io.BytesIO(converted(textured().glb, "usdz"))) as archive:
        layer = archive.read("body_textured.usdc")
    assert complaints(stages(usdz_archive({"body_textured.usdc": layer})))


@pytest.mark.parametrize("name", KNOWN)
def test_a_phone_can_show_it(name, stages):
    """ARKit's profile, as `usdchecker --arkit` had it: one binary layer, few kinds of prims."""
    content = converted(KNOWN[name]().glb, "usdz")
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        layer, *others = archive.infolist()
        assert layer.filename.endswith(".usdc")
        assert {each.filename for each in others} <= {"texture.png"}
        for each in archive.infolist():
            assert each.compress_type == zipfile.ZIP_STORED
            header = content[each.header_offset :]
            name_bytes, extra_bytes = np.frombuffer(header, "<u2", count=2, offset=26)
            assert (each.header_offset + 30 + int(name_bytes) + int(extra_bytes)) % ALIGNMENT == 0
    stage = stages(content)
    assert stage.GetDefaultPrim()
    prims = list(stage.Traverse())
    assert {prim.GetTypeName() for prim in prims} <= ARKIT_PRIMS
    shaders = [UsdShade.Shader(prim) for prim in prims if prim.IsA(UsdShade.Shader)]
    assert {each.GetIdAttr().Get() for each in shaders} <= ARKIT_SHADERS


def surface_of(stage) -> UsdShade.Shader:
    material, _ = UsdShade.MaterialBindingAPI(mesh_of(stage)).ComputeBoundMaterial()
    surface, _, _ = material.ComputeSurfaceSource()
    return surface


def test_colours_are_kept_and_the_material_has_their_mean(stages):
    known = coloured()
    stage = stages(converted(known.glb, "usdz"))
    shown = np.array(mesh_of(stage).GetDisplayColorPrimvar().Get())
    assert np.abs(shown - known.colours).max() < 1e-6
    base = np.array(surface_of(stage).GetInput("diffuseColor").Get())
    assert np.abs(base - known.colours.mean(axis=0)).max() < 1e-6
    neutral = surface_of(stages(converted(plain().glb, "usdz")))
    assert list(neutral.GetInput("diffuseColor").Get()) == pytest.approx([0.6] * 3)


def test_a_texture_comes_along_and_each_corner_shows_its_own_place_of_it(stages):
    known = textured()
    content = converted(known.glb, "usdz")
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        assert archive.read("texture.png") == known.picture
    stage = stages(content)
    texels = UsdGeom.PrimvarsAPI(mesh_of(stage)).GetPrimvar("st")
    assert texels.GetInterpolation() == UsdGeom.Tokens.faceVarying
    shown = np.array(texels.ComputeFlattened()).reshape(-1, 3, 2)
    assert np.abs(shown - known.texels[known.texel_triangles]).max() < 1e-6
    picture = surface_of(stage).GetInput("diffuseColor").GetConnectedSources()[0][0].source
    assert UsdShade.Shader(picture.GetPrim()).GetInput("file").Get().resolvedPath


def test_it_needs_no_other_time_or_place_to_be_the_same():
    for name in ("coloured", "textured"):
        glb = KNOWN[name]().glb
        assert converted(glb, "usdz") == converted(glb, "usdz")
