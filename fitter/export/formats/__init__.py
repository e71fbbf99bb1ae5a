"""The service's GLB files in other formats: OBJ, PLY and STL. Bytes in, bytes out.

Vertices and triangles are the body model's, in its order, metres, y up; an animation is shown as it
begins. ``glb_file`` reads the container, ``shown_body`` says where its vertices are and puts them
back into the model's order; each format is a module, and ``conversion`` chooses. The same bytes in
give the same bytes out.
"""

from fitter.export.formats.conversion import FORMATS, converted

__all__ = ["FORMATS", "converted"]
