"""Which limb of the body each vertex follows, for the page: a limb that is clicked turns by it.

``python -m tests.illustrations.limb_shares`` writes what the packaged body models' skinning weights
say, the mean of both genders, into the page's sources.
"""

from pathlib import Path

import numpy as np
from jaxtyping import Float, UInt8

from fitter.body.model import BodyModel
from fitter.body.storage import load_body_model, packaged_model_path

FILE = Path(__file__).parents[2] / "service" / "page" / "src" / "flip" / "shares.bin"

CHAINS = (
    ("left_upper_arm", "left_forearm", "left_hand"),
    ("right_upper_arm", "right_forearm", "right_hand"),
    ("left_thigh", "left_shin", "left_foot"),
    ("right_thigh", "right_shin", "right_foot"),
)
"""Upper limb, lower limb and what ends it; the page's flip/shares.ts says the same."""

FULL = 255


def shares() -> UInt8[np.ndarray, "4 m"]:
    """By vertex: which chain it is of, from 1 on, 0 for none; the shares of the chain's parts."""
    models = [load_body_model(packaged_model_path(gender)) for gender in ("female", "male")]
    weights = np.mean([_weights(model) for model in models], axis=0)
    names = models[0].part_names
    parts = np.stack([weights[:, [names.index(part) for part in chain]].T for chain in CHAINS])
    levels = np.round(FULL * parts).astype(np.uint8)
    chain = levels.sum(axis=1, dtype=np.int64).argmax(axis=0)
    own = levels[chain, :, np.arange(levels.shape[2])].T
    numbers = np.where(own.any(axis=0), chain + 1, 0).astype(np.uint8)
    return np.concatenate([numbers[None], own])


def _weights(model: BodyModel) -> Float[np.ndarray, "m p"]:
    spread = np.zeros((len(model.mean_vertices), len(model.part_names)))
    rows = np.arange(len(spread))[:, None]
    np.add.at(spread, (rows, model.skinning_parts), model.skinning_weights)
    return spread


if __name__ == "__main__":
    FILE.write_bytes(shares().tobytes())
