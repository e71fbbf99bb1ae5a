"""From a GLB file of the service to the same body in another format."""

from collections.abc import Callable, Mapping
from typing import Final

from fitter.export.formats.obj import mtl_file, obj_file
from fitter.export.formats.shown_body import ShownBody, shown_body


class UntexturedError(Exception):
    """A material file was asked for of a body without a texture."""


def converted(glb: bytes, ending: str) -> bytes:
    """The body of a GLB file in the format of an ending of :data:`FORMATS`.

    Raises
    ------
    UntexturedError
        If it is ``mtl`` and the body has no texture.
    """
    return FORMATS[ending](shown_body(glb))


def _mtl(body: ShownBody) -> bytes:
    if body.texture is None:
        raise UntexturedError
    return mtl_file(body, body.texture)


def _ply(body: ShownBody) -> bytes:
    # Trimesh brings a hundred modules, and is loaded by whom one of its formats is asked of.
    from fitter.export.formats.trimesh_files import ply_file

    return ply_file(body)


def _stl(body: ShownBody) -> bytes:
    from fitter.export.formats.trimesh_files import stl_file

    return stl_file(body)


FORMATS: Final[Mapping[str, Callable[[ShownBody], bytes]]] = {
    "obj": obj_file,
    "mtl": _mtl,
    "ply": _ply,
    "stl": _stl,
}
"""By the ending of a file's name; ``mtl`` is the material file of a textured OBJ."""
