"""USDZ for iPhones and whatever else shows USD; written by Pixar's own library (``usd-core``).

As ARKit wants it: one binary layer first in an uncompressed archive, y up, one unit a metre, one
default prim, UsdPreviewSurface. Colours per vertex are kept as ``displayColor``, which Blender and
usdview read; phones show the material, whose colour is their mean. Texels belong to the corners of
triangles (face-varying), so that vertices stay the model's.
"""

# The library is an extra, and says nothing of its types.
# pyright: reportMissingImports=false, reportAttributeAccessIssue=false

import io
import tempfile
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from pxr import Gf, Kind, Sdf, Usd, UsdGeom, UsdShade, Vt, Work

from fitter.export.formats.shown_body import ShownBody, Texture

# As all else in a process that answers one question at a time.
Work.SetConcurrencyLimit(1)

ROOT = "/body"
TEXELS = "st"
"""The name by which UsdPreviewSurface's texture coordinates usually go."""


def usdz_file(body: ShownBody) -> bytes:
    """The body with its material and its texture, if it has one."""
    layer = Sdf.Layer.CreateAnonymous(f"{body.name}.usdc")
    stage = Usd.Stage.Open(layer)
    stage.SetMetadata("comment", f"{body.generator}: metres, +y up")
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    root = UsdGeom.Xform.Define(stage, ROOT).GetPrim()
    Usd.ModelAPI(root).SetKind(Kind.Tokens.component)
    stage.SetDefaultPrim(root)
    mesh = _mesh(stage, body)
    binding = UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim())
    binding.Bind(_material(stage, body))
    files = {f"{body.name}.usdc": _layer_bytes(layer)}
    if body.texture is not None:
        files[body.texture.name] = body.texture.picture
    return usdz_archive(files)


def _mesh(stage: Usd.Stage, body: ShownBody) -> UsdGeom.Mesh:
    mesh = UsdGeom.Mesh.Define(stage, f"{ROOT}/mesh")
    points = Vt.Vec3fArray.FromNumpy(body.vertices.astype(np.float32))
    mesh.CreatePointsAttr(points)
    mesh.CreateExtentAttr(UsdGeom.PointBased.ComputeExtent(points))
    mesh.CreateFaceVertexCountsAttr(_integers(np.full(len(body.triangles), 3)))
    mesh.CreateFaceVertexIndicesAttr(_integers(body.triangles.ravel()))
    mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    mesh.CreateNormalsAttr(Vt.Vec3fArray.FromNumpy(body.normals.astype(np.float32)))
    mesh.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
    if body.colours is not None:
        shown = mesh.CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex)
        shown.Set(Vt.Vec3fArray.FromNumpy(body.colours.astype(np.float32)))
    if body.texture is not None:
        texels = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
            TEXELS, Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying
        )
        texels.Set(Vt.Vec2fArray.FromNumpy(body.texture.texels.astype(np.float32)))
        texels.SetIndices(_integers(body.texture.triangles.ravel()))
    return mesh


def _material(stage: Usd.Stage, body: ShownBody) -> UsdShade.Material:
    material = UsdShade.Material.Define(stage, f"{ROOT}/skin")
    surface = UsdShade.Shader.Define(stage, f"{ROOT}/skin/surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    colour = surface.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f)
    if body.texture is None:
        colour.Set(Gf.Vec3f(*body.colour.tolist()))
    else:
        colour.ConnectToSource(_texture(stage, body.texture))
    surface.CreateInput("roughness", Sdf.ValueTypeNames.Float).Set(body.roughness)
    surface.CreateInput("metallic", Sdf.ValueTypeNames.Float).Set(0.0)
    shown = surface.CreateOutput("surface", Sdf.ValueTypeNames.Token)
    material.CreateSurfaceOutput().ConnectToSource(shown)
    return material


def _texture(stage: Usd.Stage, texture: Texture) -> UsdShade.Output:
    """The shader that looks texels up, and the one that says which."""
    place = UsdShade.Shader.Define(stage, f"{ROOT}/skin/texels")
    place.CreateIdAttr("UsdPrimvarReader_float2")
    place.CreateInput("varname", Sdf.ValueTypeNames.String).Set(TEXELS)
    picture = UsdShade.Shader.Define(stage, f"{ROOT}/skin/picture")
    picture.CreateIdAttr("UsdUVTexture")
    picture.CreateInput("file", Sdf.ValueTypeNames.Asset).Set(Sdf.AssetPath(texture.name))
    picture.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("sRGB")
    for wrapped in ("wrapS", "wrapT"):
        picture.CreateInput(wrapped, Sdf.ValueTypeNames.Token).Set("clamp")
    picture.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(
        place.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    )
    return picture.CreateOutput("rgb", Sdf.ValueTypeNames.Float3)


def _integers(values: np.ndarray) -> Vt.IntArray:
    return Vt.IntArray.FromNumpy(values.astype(np.int32))


def _layer_bytes(layer: Sdf.Layer) -> bytes:
    """The layer in USD's binary format, which the library writes to files alone."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "layer.usdc"
        layer.Export(str(path))
        return path.read_bytes()


ALIGNMENT = 64
_LOCAL_HEADER_BYTES = 30
_EXTRA_HEADER_BYTES = 4
_PADDING_ID = 0x1986
"""Of the extra field that pads, as USD's own writer numbers it."""


def usdz_archive(files: Mapping[str, bytes]) -> bytes:
    """Pack files by name, without compression; the first is what the archive shows.

    Files begin at multiples of 64 bytes. Written with Python's own ``zipfile``: USD's writer notes
    when it was written, and the same body would not give the same bytes.
    """
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as packed:
        for name, content in files.items():
            # A ZipInfo of its own is dated 1980-01-01.
            entry = zipfile.ZipInfo(name)
            entry.extra = _padding(archive.tell() + _LOCAL_HEADER_BYTES + len(name.encode()))
            packed.writestr(entry, content)
    return archive.getvalue()


def _padding(start: int) -> bytes:
    """An extra field after which a file that would begin at ``start`` is aligned."""
    length = -(start + _EXTRA_HEADER_BYTES) % ALIGNMENT
    header = _PADDING_ID.to_bytes(2, "little") + length.to_bytes(2, "little")
    return header + bytes(length)
