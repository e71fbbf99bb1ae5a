"""How far a click may lie from the landmark it means, as a length on the body.

A hand on the mouse errs by 2 to 3 pixels where a person fills most of a 640 x 480 picture, about a
centimetre on the body. What people take the point to be adds to that, and differs by landmark: an
eye is where it is, but a hip is clicked anywhere between the joint and the hip's bulge, and a head
top under hair is a guess. Believing all clicks alike turns the trunk by tens of degrees to explain
hips clicked a little wide or narrow.
"""

from collections.abc import Mapping

from fitter.request import Click

DEFAULT_SPREAD_M = 0.015
SPREADS_M: Mapping[str, float] = {
    "left_hip": 0.025,
    "right_hip": 0.025,
    "left_shoulder": 0.02,
    "right_shoulder": 0.02,
    "neck": 0.03,
    "head_top": 0.03,
    "left_toe": 0.02,
    "right_toe": 0.02,
}
"""Standard deviations in each direction of the picture, metres, where clicks are all there is.
Others have the default."""

BODY_CLICK_SPREAD_M = 0.02
"""The same of every click once a body is fitted to the picture, which says more: people differ by
as much in where a joint is. With the table above there too, waists of the tuning half err by 2.5 cm
for 2.3 on the mean, chests of 16 foreign bodies by 3.9 for 4.1: no gain that holds."""

OCCLUDED_FACTOR = 3.0
"""How much less a hidden point's click is believed."""


def click_spread_m(name: str, click: Click) -> float:
    """Standard deviation of a point in each direction of the picture, metres on the body.

    That of a proposed point comes with it, and knows whether the point is hidden.
    """
    if click.spread_m is not None:
        return click.spread_m
    return SPREADS_M.get(name, DEFAULT_SPREAD_M) * (OCCLUDED_FACTOR if click.occluded else 1.0)
