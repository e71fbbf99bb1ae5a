"""
Bodies without a picture
========================

The most probable woman of 1.70 m at four weights. Only height and weight are known; all else
follows from how bodies vary. The same is ``POST /v1/bodies`` over HTTP.
"""

from _extensions.drawing import bodies_picture, show

from fitter import Gender, estimate_body
from fitter.fits.prepared_model import prepared_model

triangles = prepared_model(Gender.FEMALE).operators.model.triangles
estimates = {
    weight: estimate_body(Gender.FEMALE, {"stature": 170.0, "weight": float(weight)})
    for weight in (52, 65, 80, 100)
}
show(
    bodies_picture(
        {f"{weight} kg": each.canonical_vertices for weight, each in estimates.items()}, triangles
    )
)

# %%
# How far each waist is known from height and weight alone:

for weight, estimate in estimates.items():
    waist = next(
        e.measurement for e in estimate.measurements if e.measurement.name == "waist_girth_navel"
    )
    print(f"{weight:3} kg: waist {waist.value:.0f} ± {waist.standard_error:.1f} cm")
