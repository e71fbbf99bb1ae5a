"""
One picture, one body
=====================

The first sample of the page: clicked joints, a gender and a height. The outline is the fitted
body's; beside it the body from other sides, which is where one sees whether it can be right.
"""

from _extensions.drawing import sample_request, show

from fitter import files_of, fit

request = sample_request()
result = fit(request)
files = files_of(result, request.views[0].image)
show(files["views/0/overlay.png"], titles=("the outline over the picture",))

# %%
# As clay, posed and canonical.

show(files["views/0/views.png"])

# %%
# Measurements come with a standard error each. What was given, here the height, is met exactly.

for each in result.measurements[:8]:
    print(f"{each.name:22} {each.value:6.1f} ± {each.standard_error or 0.0:.1f} {each.unit.value}")
