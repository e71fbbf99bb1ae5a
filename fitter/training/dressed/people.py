"""Random dressed people: a body and the layers of what they wear."""

from typing import Final

import numpy as np

from fitter.training.dressed.bodies import StandingBody, standing_body
from fitter.training.dressed.cloths import cloth, hair_colour, skin_colour
from fitter.training.dressed.garments import (
    pick,
    skirt,
    top,
    trousers,
    underwear,
    waist_height,
)
from fitter.training.dressed.heads_and_feet import footwear, hair, skin
from fitter.training.dressed.outer_garments import outer
from fitter.training.dressed.surfaces import Layer
from fitter.vocabulary.choices import Gender

WOMENS: Final = {"trousers": 0.77, "dress": 0.11, "skirt": 0.08, "swimwear": 0.04}
MENS: Final = {"trousers": 0.94, "swimwear": 0.03, "bare chest": 0.03}

WITH_OUTER: Final = 0.5
OVER_BARE: Final = 0.2
"""How often something is worn over a top; over none, this share of it."""

TUCKED: Final = 0.3


def dressed_person(rng: np.random.Generator) -> tuple[StandingBody, list[Layer]]:
    """A person who stands, and everything to be drawn of them."""
    body = standing_body(rng)
    colours = skin_colour(rng), hair_colour(rng)
    style = pick(rng, WOMENS if body.rest.gender is Gender.FEMALE else MENS)
    topless = style in ("swimwear", "bare chest")
    layers = [skin(body, *colours, rng), underwear(body, rng)]
    fabric = cloth(rng)
    match style:
        case "trousers" | "bare chest":
            layers += trousers(body, rng)
        case "skirt":
            layers += skirt(body, rng, cloth(rng, plain=0.75), from_height=waist_height(body, rng))
        case "dress":
            bust = float(body.rest.marks["left_nipple"][1])
            layers += skirt(body, rng, fabric, from_height=bust + 0.02)
        case _:
            pass
    if not topless:
        tucked = style == "trousers" and rng.random() < TUCKED
        layers += top(body, rng, fabric, dress=style == "dress", tucked=tucked)
    if rng.random() < WITH_OUTER * (OVER_BARE if topless else 1.0):
        layers += outer(body, rng)
    return body, [*layers, *footwear(body, rng), *hair(body, colours[1], rng)]
