"""How much people differ in each measurement from a model's nearest body.

A model's header says so of what was measured when it was trained. Of measurements defined since
then ``unexplained.json`` beside this file says it of the packaged models, by their checksums; the
command ``python -m fitter.training report --unexplained FILE`` writes it.
"""

import json
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.errors import DefinitionError

UNEXPLAINED_KEY = "unexplained_measurements"
"""Field of a model's header."""

UNEXPLAINED_PATH = Path(__file__).with_name("unexplained.json")


def unexplained(model: BodyModel, names: Sequence[str]) -> Float[np.ndarray, " k"]:
    """One standard deviation of each, in its unit.

    Zero where nothing is said, as for models without people to test on.
    """
    said = model.header.get(UNEXPLAINED_KEY)
    by_name = _since().get(model.checksum, {}) | (dict(said) if isinstance(said, Mapping) else {})
    return np.array([float(by_name.get(name, 0.0)) for name in names])


@cache
def _since(path: Path = UNEXPLAINED_PATH) -> Mapping[str, dict[str, float]]:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        message = f"{path.name} cannot be read as JSON ({error})."
        raise DefinitionError(message) from error
