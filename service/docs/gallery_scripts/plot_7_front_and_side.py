"""
Front and side
==============

One picture cannot show how deep a trunk is. Here the packaged pair of pictures is fitted three
times: the front alone, the side alone, and both as pictures of one person. Bars are 95 %
intervals.
"""

import json

import matplotlib.pyplot as plt
from _extensions.drawing import show

from fitter import Click, FitRequest, Gender, fit
from fitter.fits.scan import ScanView, scan
from fitter.request import ViewKind
from service.demo_data.sample import load_scan_sample

sample = load_scan_sample()
asked = json.loads(sample.request)
show(*sample.images, titles=("front", "side"))

# %%

views = [
    ScanView(
        kind=ViewKind(view["view"]),
        request=FitRequest(
            image=image,
            clicks={name: Click(x=x, y=y) for name, (x, y, seen) in view["points"].items() if seen},
            gender=Gender(asked["gender"]),
            height_m=asked["height_m"],
        ),
    )
    for view, image in zip(asked["views"], sample.images, strict=True)
]
found = {
    "front": fit(views[0].request).measurements,
    "side": fit(views[1].request).measurements,
    "front and side": scan(views).measurements,
}

# %%

NAMES = ("chest_girth", "waist_girth_smallest", "hip_girth", "thigh_girth", "weight")
figure, axes = plt.subplots(1, len(NAMES), figsize=(9, 3), layout="constrained")
for axis, name in zip(axes, NAMES, strict=True):
    for row, measurements in enumerate(found.values()):
        each = next(each for each in measurements if each.name == name)
        axis.errorbar(each.value, row, xerr=1.96 * each.standard_error, fmt="o", capsize=3)
    axis.set_title(f"{name.replace('_', ' ')}, {each.unit.value}", fontsize=9)
    axis.set_yticks(range(len(found)), found if axis is axes[0] else [""] * len(found))
    axis.set_ylim(-0.6, len(found) - 0.4)
    axis.invert_yaxis()
plt.show()
