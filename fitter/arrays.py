"""Names for the arrays that travel between stages.

One letter means one dimension everywhere: ``m`` vertices, ``f`` triangles, ``n`` shape
coefficients, ``p`` body parts, ``h`` x ``w`` pixels, ``k`` points; ``_`` any length, of each array
its own.

Image coordinates are continuous pixels: the origin is the top-left corner of the picture and
the centre of the top-left pixel is (0.5, 0.5); x runs right, y runs down.

Frames. *Body frame*: metres, x to the person's left, y up, z the way the person faces.
*Camera frame*: metres, OpenCV axes, x right, y down, z along the view.
"""

import numpy as np
from jaxtyping import Bool, Float, Integer

Vertices = Float[np.ndarray, "m 3"]
Normals = Float[np.ndarray, "m 3"]
Triangles = Integer[np.ndarray, "f 3"]
PerVertex = Float[np.ndarray, " m"]
PerTriangle = Float[np.ndarray, " f"]
Points2D = Float[np.ndarray, "k 2"]
Points3D = Float[np.ndarray, "k 3"]
Pose = Float[np.ndarray, "p 3"]
Rotations = Float[np.ndarray, "p 3 3"]
Shape = Float[np.ndarray, " n"]
ShapeCovariance = Float[np.ndarray, "n n"]
Vector3 = Float[np.ndarray, "3"]
Image = Float[np.ndarray, "h w 3"]
GreyImage = Float[np.ndarray, "h w"]
Mask = Bool[np.ndarray, "h w"]
