"""The clicked points in the form the first pose uses."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Points2D
from fitter.observation.clicks import click_spread_m
from fitter.request import Click


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class ClickedPoints:
    """Clicks by canonical name.

    Attributes
    ----------
    names
        k landmark names.
    pixels
        (k, 2) continuous pixels.
    spread_m
        (k,) standard deviation in each direction, metres on the body.
    """

    names: tuple[str, ...]
    pixels: Points2D
    spread_m: Float[np.ndarray, " k"]

    def pixel(self, name: str) -> Float[np.ndarray, "2"] | None:
        """The click of this name, (2,), or None."""
        return self.pixels[self.names.index(name)] if name in self.names else None

    def by_name(self) -> dict[str, Float[np.ndarray, "2"]]:
        """Pixels by name."""
        return dict(zip(self.names, self.pixels, strict=True))

    def only(self, names: tuple[str, ...]) -> "ClickedPoints":
        """Those of the names that were clicked, in this order."""
        kept = [self.names.index(name) for name in names if name in self.names]
        return ClickedPoints(
            names=tuple(self.names[i] for i in kept),
            pixels=self.pixels[kept],
            spread_m=self.spread_m[kept],
        )


def clicked_points(clicks: Mapping[str, Click]) -> ClickedPoints:
    """Clicks as arrays."""
    return ClickedPoints(
        names=tuple(clicks),
        pixels=np.array([[c.x, c.y] for c in clicks.values()], dtype=np.float64).reshape(-1, 2),
        spread_m=np.array([click_spread_m(*each) for each in clicks.items()]),
    )
