"""The names of all measurements and their units.

``fitter/measurement/definitions.json`` has them. It is read here without the code that measures by
it, so that names can be checked where no numerics are loaded.
"""

import json
from collections.abc import Mapping
from importlib.resources import files
from types import MappingProxyType
from typing import Final

STATURE: Final = "stature"
"""The measurement that a request's ``height_m`` is in metres."""


def _units() -> Mapping[str, str]:
    text = files("fitter.measurement").joinpath("definitions.json").read_text(encoding="utf-8")
    return MappingProxyType(
        {each["name"]: each["unit"] for each in json.loads(text)["measurements"]}
    )


MEASUREMENT_UNITS: Final = _units()
"""The unit, ``cm`` or ``kg``, of each measurement by its name, in the order they are listed."""
