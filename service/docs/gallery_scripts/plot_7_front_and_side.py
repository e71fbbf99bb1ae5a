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

from fitter import Click, FitRequest, Gender, Person, View, ViewKind, fit
from service.demo_data.sample import load_views_sample

sample = load_views_sample()
asked = json.loads(sample.request)
show(*sample.images, titles=("front", "side"))

# %%

person = Person(gender=Gender(asked["gender"]), height_m=asked["height_m"])
front, side = (
    View(
        image=image,
        kind=ViewKind(view["view"]),
        clicks={name: Click(x=x, y=y) for name, (x, y, seen) in view["points"].items() if seen},
    )
    for view, image in zip(asked["views"], sample.images, strict=True)
)
found = {
    name: fit(FitRequest(person=person, views=views)).measurements
    for name, views in {
        "front": (front,),
        "side": (side,),
        "front and side": (front, side),
    }.items()
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
