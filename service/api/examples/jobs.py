"""Examples of jobs: how they are submitted, where they stand, what they report."""

from typing import Any, Final

from api_schemas.problems import problem
from service.api.examples.estimates import PICTURE_ID, POINTS

FIT_ID: Final = "b0d3cd76-33ef-4c01-b18c-190159d7df68"
_PATH: Final = f"/v1/fits/{FIT_ID}"
_ACCEPTED_AT: Final = "2026-05-04T09:30:00.995Z"
_STARTED_AT: Final = "2026-05-04T09:30:01.170Z"
_ENDED_AT: Final = "2026-05-04T09:30:03.612Z"
_EXPIRES_AT: Final = "2026-05-11T09:30:03.612Z"

SUBMISSIONS: Final[dict[str, Any]] = {
    "uploaded-picture": {
        "image_id": PICTURE_ID,
        "gender": "male",
        "height_m": 1.8,
        "points": POINTS,
    },
    "points-proposed": {
        "image_id": PICTURE_ID,
        "gender": "female",
        "height_m": 1.68,
        "points": "auto",
    },
    "told-of-its-end": {
        "image_id": PICTURE_ID,
        "gender": "male",
        "weight_kg": 75,
        "measurements": {"stature": 180, "hip_girth": {"value": 98, "standard_error": 1.5}},
        "points": POINTS,
        "focal_length_35mm": 50,
        "cues": "SE",
        "label": "customer-4711",
        "webhook": {
            "url": "https://example.org/hooks/maquette",
            "secret": "whsec_C2FVsBQIhrscChlQIMV+b5sSYspob7oD",
        },
    },
}


def _job(state: str, *, links: dict[str, Any] | None = None, **changes: Any) -> dict[str, Any]:
    standing = {
        "id": FIT_ID,
        "state": state,
        "stage": None,
        "progress": 0.0,
        "attempt": 0,
        "cancel_requested": False,
        "created_at": _ACCEPTED_AT,
        "started_at": None,
        "finished_at": None,
        "expires_at": None,
        "problem": None,
        "webhook": None,
        "links": {
            "self": _PATH,
            "events": f"{_PATH}/events",
            "image": f"{_PATH}/image",
            "mask": None,
            "request": f"{_PATH}/request",
            "derivations": None,
            "cancel": f"{_PATH}/cancel",
            "retry": None,
            "result": None,
            "artifacts": {},
        }
        | (links or {}),
    }
    return standing | changes


_STARTED: Final[dict[str, Any]] = {"attempt": 1, "started_at": _STARTED_AT}
_OVER: Final[dict[str, Any]] = _STARTED | {"finished_at": _ENDED_AT, "expires_at": _EXPIRES_AT}
_LINKS_WHEN_OVER: Final[dict[str, Any]] = {"cancel": None, "retry": f"{_PATH}/retry"}

QUEUED: Final = _job("queued")
RUNNING_JOB: Final = _job("running", stage="silhouette_and_edges", progress=0.42, **_STARTED)
STOPPING: Final = RUNNING_JOB | {"cancel_requested": True}
SUCCEEDED: Final = _job(
    "succeeded",
    stage="measurement",
    progress=1.0,
    **_OVER,
    webhook={
        "state": "delivered",
        "attempts": 1,
        "last_status": 204,
        "last_error": None,
        "next_attempt_at": None,
    },
    links=_LINKS_WHEN_OVER
    | {
        "derivations": f"{_PATH}/derivations",
        "result": f"{_PATH}/result",
        "artifacts": {
            name: f"{_PATH}/artifacts/{name}"
            for name in ("body_posed.glb", "overlay.png", "result.json")
        },
    },
)
FAILED: Final = _job(
    "failed",
    stage="observation",
    **_OVER,
    problem=problem(
        "unusable-input",
        code="image-damaged",
        field="image",
        detail="image: The picture ends too early.",
        remedy="Send the whole file.",
    ).model_dump(mode="json"),
    links=_LINKS_WHEN_OVER,
)
CANCELED: Final = _job("canceled", **_OVER, cancel_requested=True, links=_LINKS_WHEN_OVER)

ACCEPTED: Final = {"queued": QUEUED}
RUNNING: Final = {"running": RUNNING_JOB}
ENDED: Final = {"succeeded": SUCCEEDED, "failed": FAILED}

TOKEN: Final[dict[str, Any]] = {
    "id": "5f1c9a7be0d24c63",
    "token": "mqt_5f1c9a7be0d24c63_Zk3Qm0v4cP1sYw8rT6uXh2bNa9eLd7oGjKfVxRiCtEy",
    "expires_at": "2026-05-04T09:45:00.995Z",
    "jobs": 2,
    "label": "customer-4711",
}

STANDING_TOKEN: Final[dict[str, Any]] = {
    "id": TOKEN["id"],
    "key_id": "1f2e3d4c",
    "label": "customer-4711",
    "created_at": "2026-05-04T09:30:00.995Z",
    "expires_at": TOKEN["expires_at"],
    "jobs": 2,
    "jobs_left": 1,
    "images": 1,
    "most_images": 24,
}

TOKENS: Final[dict[str, Any]] = {"tokens": [STANDING_TOKEN], "next": None}

PEOPLE: Final[dict[str, Any]] = {
    "people": [
        {
            "label": "customer-4711",
            "fits": 2,
            "scans": 1,
            "latest": _PATH,
            "latest_at": _ACCEPTED_AT,
        }
    ],
    "next": "/v1/people?limit=1&cursor=customer-4711",
}

PAGE: Final[dict[str, Any]] = {
    "jobs": [RUNNING_JOB, SUCCEEDED],
    "next": f"/v1/fits?limit=2&cursor=1777887000.995-{FIT_ID}",
}

OPTIONS: Final[dict[str, Any]] = {
    "height_m": 1.8,
    "weight_kg": None,
    "measurements": {"hip_girth": {"value": 98.0, "standard_error": 1.5}},
    "gender": "male",
    "points": {
        name: {"x": x, "y": y, "visibility": 2} for name, (x, y) in list(POINTS.items())[:6]
    },
    "format": "named",
    "focal_length_px": None,
    "focal_length_35mm": None,
    "limb_facing": {"left_forearm": "toward"},
    "cues": "SES",
    "optimizer": "gauss_newton",
    "clothing": "tight",
    "light": {
        "kind": "point",
        "azimuth_deg": None,
        "elevation_deg": None,
        "distance_m": None,
        "surroundings": "uniform",
    },
}

EVENTS: Final = """\
retry: 1000

event: state
data: {"state":"running","stage":null,"progress":0.0,"energies":{},"at":"2026-05-04T09:30:01.170Z"}
id: 2

event: progress
data: {"state":"running","stage":"segmentation","progress":0.09,"energies":{"silhouette":21.9,\
"edges":8.1},"at":"2026-05-04T09:30:01.812Z"}
id: 3

event: end
data: {"state":"succeeded","stage":"measurement","progress":1.0,"energies":{},\
"at":"2026-05-04T09:30:03.612Z"}
id: 4

"""

NOTICE: Final[dict[str, Any]] = {
    "type": "fit.succeeded",
    "timestamp": _ENDED_AT,
    "data": SUCCEEDED | {"webhook": None},
}
