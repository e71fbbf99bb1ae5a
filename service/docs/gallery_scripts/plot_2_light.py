"""
Light and reflectance
=====================

Shape from shading (section 5 of the paper) finds a direction to the light, and for every vertex
how much it reflects. The three pictures are the sample, its shading alone, and the albedo alone:
their product is the picture.
"""

import numpy as np
from _extensions.drawing import sample_request, show

from fitter import files_of, fit

request = sample_request()
result = fit(request)
files = files_of(result, request.image)
show(files["shading.png"], files["albedo.png"], titles=("shading", "albedo"))

# %%
# Where the light comes from: azimuth from the camera's side toward the right of the picture,
# elevation upward.

light = result.person.light
assert light is not None
azimuth, elevation = np.degrees([light.azimuth, light.elevation])
print(f"{light.kind.value}: azimuth {azimuth:.0f}°, elevation {elevation:.0f}°")
