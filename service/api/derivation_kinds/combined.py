"""One person from several pictures: made of what several fits were made of."""

from typing import Any, Final

from api_schemas.derivation_kinds import DerivationKind
from api_schemas.derivation_kinds.combined import CombinedOptions, CombinedResult
from service.api.derivation_kinds.definition import DerivationKindDefinition, Needs
from service.api.examples.files import files
from service.api.examples.jobs import FIT_ID
from service.api.examples.results import RESULT as RESULT_OF_A_FIT
from service.jobs.inputs import OF_EACH_FIT

OTHER_FIT_ID: Final = "0d3c1b6e-52a4-4f0e-9e37-0a4f6c2f7d10"


def _picture(number: int, fit_id: str) -> dict[str, Any]:
    """What a fit found, for one of several pictures."""
    same = ("outcome", "image_camera", "body", "light", "reflectance", "silhouette_overlap")
    return {"number": number, "fit_id": fit_id} | {name: RESULT_OF_A_FIT[name] for name in same}


KIND: Final = DerivationKindDefinition(
    kind=DerivationKind.COMBINED,
    options=CombinedOptions,
    result=CombinedResult,
    needs=lambda options: Needs(
        of_fit=OF_EACH_FIT,
        other_fits={f"fits.{place}": fit for place, fit in enumerate(options.fits)},
        of_others=OF_EACH_FIT,
    ),
    requests={"combined": {"kind": "combined", "fits": [OTHER_FIT_ID]}},
    answer={
        "artifacts": files(
            body_combined__glb=699700,
            body_posed_1__glb=699700,
            body_posed_2__glb=699700,
            combined__png=160500,
            overlay_1__png=812300,
            overlay_2__png=798100,
        ),
        "kind": "combined",
        "pictures": 2,
        "shape": [0.813, -1.386, -0.711],
        "bodies": [
            _picture(1, FIT_ID),
            _picture(2, OTHER_FIT_ID),
        ],
        "measurements": [RESULT_OF_A_FIT["measurements"][-1]],
        "agreement": 0.84,
        "warnings": [],
    },
)
