"""Examples of what the service says of itself."""

from typing import Any, Final

from api_schemas.body_models import BodyModels
from api_schemas.problems import PROBLEM_TYPES

_SOURCES: Final = (
    "MakeHuman / MPFB2 base mesh, targets, rig and skinning weights",
    "ANSUR II, anthropometric survey of the US Army, 2012: means and covariances",
)


def _body_model(gender: str, mean_height_m: float, checksum: str) -> dict[str, Any]:
    return {
        "gender": gender,
        "mean_height_m": mean_height_m,
        "vertices": 12440,
        "triangles": 24876,
        "shape_coefficients": 20,
        "parts": ["pelvis", "spine"],
        "landmarks": ["nose", "left_eye"],
        "format_version": 1,
        "checksum": checksum,
        "sources": _SOURCES,
        "licences": ["CC0-1.0 (MakeHuman / MPFB2 assets)"],
    }


BODY_MODELS: Final = BodyModels.model_validate(
    {
        "models": (
            _body_model("female", 1.65, "a36fddfa54208ca9bcb202d5a591ca5e90624015b833167abe83db"),
            _body_model("male", 1.82, "508ecffdd27d69eec5e63aa83988f2b348b5d12e08929c266bc05c45"),
        )
    },
    strict=False,
).model_dump(mode="json")

METRICS: Final = """\
# HELP maquette_queue_jobs Jobs that wait.
# TYPE maquette_queue_jobs gauge
maquette_queue_jobs 3.0
# HELP maquette_jobs_ended_total Jobs that ever ended, by state.
# TYPE maquette_jobs_ended_total counter
maquette_jobs_ended_total{state="succeeded"} 128.0
"""

PROBLEM_TYPE: Final = PROBLEM_TYPES["no-result"].model_dump(mode="json")
