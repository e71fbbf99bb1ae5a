"""Examples of scans: how they are submitted, where they stand, what they find."""

from typing import Any, Final

from api_schemas.problems import FieldProblem, field_problem, problem
from service.api.examples import derivations, jobs
from service.api.examples.estimates import PICTURE_ID, POINTS
from service.api.examples.files import files
from service.api.examples.results import RESULT as RESULT_OF_A_FIT

SCAN_ID: Final = "7c9f2f0e-3d1a-4a7e-8a53-5e0d9b1c2f44"
_PATH: Final = f"/v1/scans/{SCAN_ID}"
SIDE_PICTURE_ID: Final = "9b74c9897bac770ffc029102a200c5de7c0d3bc6f4d4e8ac9a1a2c4c5d6e7f80"

SUBMISSIONS: Final[dict[str, Any]] = {
    "front-and-side": {
        "gender": "male",
        "height_m": 1.8,
        "weight_kg": 75.2,
        "views": [
            {"view": "front", "image_id": PICTURE_ID, "points": POINTS},
            {"view": "side", "image_id": SIDE_PICTURE_ID, "points": "auto"},
        ],
    },
    "told-of-its-end": {
        "gender": "female",
        "height_m": 1.68,
        "measurements": {"waist_girth_navel": {"value": 78, "standard_error": 1.5}},
        "views": [
            {"view": "front", "image_id": PICTURE_ID, "focal_length_35mm": 26},
            {"view": "side", "image_id": SIDE_PICTURE_ID, "focal_length_35mm": 26},
        ],
        "webhook": {"url": "https://example.org/hooks/maquette"},
    },
}

_LINKS: Final[dict[str, Any]] = {
    "self": _PATH,
    "events": f"{_PATH}/events",
    "views": [{"image": f"{_PATH}/views/{number}/image", "mask": None} for number in range(2)],
    "request": f"{_PATH}/request",
    "derivations": None,
    "cancel": f"{_PATH}/cancel",
    "retry": None,
    "result": None,
    "artifacts": {},
}
_LINKS_WHEN_OVER: Final[dict[str, Any]] = {"cancel": None, "retry": f"{_PATH}/retry"}


def _scan(fit: dict[str, Any], *, links: dict[str, Any] | None = None, **changes: Any) -> Any:
    """A scan that stands where a fit does."""
    return fit | {"id": SCAN_ID, "view": None, "links": _LINKS | (links or {})} | changes


_FILES: Final = files(
    body_canonical__glb=699700,
    body_posed_0__glb=1098472,
    body_posed_1__glb=1098472,
    overlay_0__png=812300,
    overlay_1__png=798100,
    scan__png=121500,
)

QUEUED: Final = _scan(jobs.QUEUED)
RUNNING: Final = _scan(jobs.RUNNING_JOB, view=1)
STOPPING: Final = _scan(jobs.STOPPING, view=1)
SUCCEEDED: Final = _scan(
    jobs.SUCCEEDED,
    stage="export",
    links=_LINKS_WHEN_OVER
    | {
        "derivations": f"{_PATH}/derivations",
        "result": f"{_PATH}/result",
        "artifacts": {
            name: f"{_PATH}/artifacts/{name}"
            for name in (*(each["name"] for each in _FILES), "result.json")
        },
    },
)
FAILED: Final = _scan(
    jobs.FAILED,
    links=_LINKS_WHEN_OVER,
    problem=problem(
        "unusable-input",
        code="image-damaged",
        field="views.1.image",
        detail="views.1.image: The picture ends too early.",
        remedy="Send the whole file.",
    ).model_dump(mode="json"),
)
CANCELED: Final = _scan(jobs.CANCELED, links=_LINKS_WHEN_OVER)

ACCEPTED: Final = {"queued": QUEUED}
UNDER_WAY: Final = {"running": RUNNING}
ENDED: Final = {"succeeded": SUCCEEDED, "failed": FAILED}
PAGE: Final[dict[str, Any]] = {
    "scans": [RUNNING, SUCCEEDED],
    "next": f"/v1/scans?limit=2&cursor=1777887000.995-{SCAN_ID}",
}

REFUSED: Final[dict[str, Any]] = {
    "two-fronts": field_problem(
        "invalid-request",
        FieldProblem(
            field="views.1.view",
            code="repeated-view",
            reason="Two pictures are said to show the front.",
            remedy="Send one of them, or say what the other shows: side, back, other.",
        ),
    ).model_dump(mode="json"),
    "one-view": field_problem(
        "invalid-request",
        FieldProblem(
            field="views",
            code="views-count",
            reason="A scan has 2 to 6 pictures, not 1.",
            remedy="Send the person from the front and from the side, and more if there are.",
        ),
    ).model_dump(mode="json"),
    "damaged-second-picture": field_problem(
        "invalid-request",
        FieldProblem(
            field="views.1.image",
            code="image-damaged",
            reason="The file is damaged: it ends within its header.",
            remedy="Send the whole file, or save the picture anew.",
        ),
    ).model_dump(mode="json"),
}

_OF_A_VIEW: Final = ("points", "format", "focal_length_px", "focal_length_35mm", "limb_facing")
OPTIONS: Final[dict[str, Any]] = {
    name: value
    for name, value in jobs.OPTIONS.items()
    if name in ("height_m", "weight_kg", "measurements", "gender", "cues")
} | {
    "force": False,
    "views": [
        {"view": view, "complete_points": False}
        | {name: jobs.OPTIONS[name] for name in (*_OF_A_VIEW, "clothing", "light")}
        for view in ("front", "side")
    ],
}

EVENTS: Final = """\
retry: 1000

event: progress
data: {"state":"running","stage":"segmentation","view":1,"progress":0.21,"energies":{},\
"at":"2026-05-04T09:30:01.812Z"}
id: 3

event: end
data: {"state":"succeeded","stage":"export","view":null,"progress":1.0,"energies":{},\
"at":"2026-05-04T09:30:03.612Z"}
id: 4

"""


def _view(number: int, view: str) -> dict[str, Any]:
    same = (
        *("outcome", "outcome_explanation", "verdict", "camera", "image_camera"),
        *("focal_length_source", "body", "stance", "light", "reflectance"),
        *("silhouette_overlap", "limb_facing", "assumptions", "warnings"),
    )
    return {"number": number, "view": view, "findings": []} | {
        name: RESULT_OF_A_FIT[name] for name in same
    }


def _stage(of_a_fit: dict[str, Any]) -> dict[str, Any]:
    """The same stage, of two pictures."""
    in_a_picture = ("silhouette_overlap", "body")
    same = {name: value for name, value in of_a_fit.items() if name not in in_a_picture}
    return same | {"views": [{name: of_a_fit[name] for name in in_a_picture}] * 2}


RESULT: Final[dict[str, Any]] = {
    name: RESULT_OF_A_FIT[name]
    for name in (
        *("gender", "height_m", "cues", "optimizer", "verdict", "outcome_explanation"),
        *("energies", "evaluations", "measurements", "stage_seconds"),
    )
} | {
    "stages": [_stage(each) for each in RESULT_OF_A_FIT["stages"]],
    "shape": [0.8131, -1.3443, 0.2107],
    "views": [_view(0, "front"), _view(1, "side")],
    "agreement": 0.84,
    "assumptions": [],
    "warnings": [],
    "artifacts": _FILES,
}

NOTICE: Final[dict[str, Any]] = {
    "type": "scan.succeeded",
    "timestamp": SUCCEEDED["finished_at"],
    "data": SUCCEEDED | {"webhook": None},
}


def _derivation(of_a_fit: dict[str, Any]) -> dict[str, Any]:
    """The same derivation, a caricature of a scan."""
    path = f"{_PATH}/derivations/{derivations.DERIVATION_ID}"
    links = {
        name: link.replace(of_a_fit["links"]["self"], path) if isinstance(link, str) else link
        for name, link in of_a_fit["links"].items()
        if name != "fit"
    } | {"scan": _PATH}
    if links["artifacts"]:
        links["artifacts"] = {
            name: f"{path}/artifacts/{name}"
            for name in ("body_caricature.glb", "caricature.png", "result.json")
        }
    standing = {name: value for name, value in of_a_fit.items() if name != "fit_id"}
    stage = "caricature" if of_a_fit["stage"] == "report" else of_a_fit["stage"]
    return standing | {
        "kind": "caricature",
        "stage": stage,
        "scan_id": SCAN_ID,
        "links": links,
    }


DERIVATION_QUEUED: Final = _derivation(derivations.QUEUED)
DERIVATION_STOPPING: Final = _derivation(derivations.STOPPING)
DERIVATION_CANCELED: Final = _derivation(derivations.CANCELED)
DERIVATION_SUCCEEDED: Final = _derivation(derivations.SUCCEEDED)
DERIVATION_ACCEPTED: Final = {"queued": DERIVATION_QUEUED}
DERIVATION_ENDED: Final = {"succeeded": DERIVATION_SUCCEEDED}
DERIVATION_PAGE: Final[dict[str, Any]] = {"derivations": [DERIVATION_SUCCEEDED], "next": None}
DERIVATION_NOTICE: Final[dict[str, Any]] = {
    "type": "derivation.succeeded",
    "timestamp": SUCCEEDED["finished_at"],
    "data": DERIVATION_SUCCEEDED,
}
