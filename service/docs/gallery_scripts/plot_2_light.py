"""
Light and reflectance
=====================

Shape from shading (section 5 of the paper) finds a direction to the light, and for every vertex
how much it reflects. As in the paper's Fig. 7 the pictures are the sample, the albedo, the albedo
in the light, and all of Eq. 1, with highlights, which is to come near the sample's brightness.
"""

import numpy as np
from _extensions.drawing import sample_request, show

from fitter import files_of, fit

request = sample_request()
result = fit(request)
files = files_of(result, request.views[0].image)
show(
    request.views[0].image,
    files["views/0/albedo.png"],
    files["views/0/shading_lambertian.png"],
    files["views/0/shading.png"],
    titles=("picture", "albedo", "Lambertian", "Blinn-Phong"),
)

# %%
# Where the light comes from: azimuth from the camera's side toward the right of the picture,
# elevation upward.

light = result.person.light
assert light is not None
azimuth, elevation = np.degrees([light.azimuth, light.elevation])
print(f"{light.kind.value}: azimuth {azimuth:.0f}°, elevation {elevation:.0f}°")
