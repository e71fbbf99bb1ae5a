"""Examples of derivations: what is asked for, where they stand, what they give."""

from typing import Any, Final

from service.api.examples import jobs
from service.api.examples.results import RESULT

_FIT_PATH: Final = f"/v1/fits/{jobs.FIT_ID}"
DERIVATION_ID: Final = "5f1c2a34-8b1e-4c57-9a1d-0c6f3f0f9b21"
_PATH: Final = f"{_FIT_PATH}/derivations/{DERIVATION_ID}"

REQUESTS: Final[dict[str, Any]] = {
    "report": {"kind": "report"},
    "caricature": {"kind": "caricature", "factor": 2.5},
    "pose": {
        "kind": "pose",
        "pose": "standing",
        "rotations": {"head": [0.0, 0.35, 0.0], "left_forearm": [0.0, 0.0, 0.0, 1.0]},
    },
    "walk": {"kind": "animation"},
    "figure": {"kind": "figure", "pose": "arms_raised", "degrees": 30},
    "texture": {"kind": "texture", "colours": "albedo", "size": 2048},
    "combined": {"kind": "combined", "fits": ["0d3c1b6e-52a4-4f0e-9e37-0a4f6c2f7d10"]},
    "told-of-its-end": {
        "kind": "report",
        "webhook": {"url": "https://example.org/hooks/maquette"},
    },
}

UNDERSTOOD: Final[dict[str, Any]] = {
    "report": {"kind": "report"},
    "pose": {"kind": "pose", "pose": "sitting", "rotations": {}},
}


def _derivation(fit: dict[str, Any], **changes: Any) -> dict[str, Any]:
    """A derivation that stands where a fit does."""
    standing = {name: value for name, value in fit.items() if name != "links"}
    links = {
        "self": _PATH,
        "fit": _FIT_PATH,
        "events": f"{_PATH}/events",
        "request": f"{_PATH}/request",
        "cancel": f"{_PATH}/cancel" if fit["links"]["cancel"] else None,
        "retry": None if fit["links"]["cancel"] else f"{_PATH}/retry",
        "result": None,
        "artifacts": {},
    }
    mine = {
        "id": DERIVATION_ID,
        "kind": "report",
        "fit_id": jobs.FIT_ID,
        "expires_at": jobs.SUCCEEDED["expires_at"],
        "webhook": None,
        "links": links | changes.pop("links", {}),
    }
    return standing | mine | changes


QUEUED: Final = _derivation(jobs.QUEUED)
STOPPING: Final = _derivation(jobs.STOPPING, stage="report", progress=0.5)
CANCELED: Final = _derivation(jobs.CANCELED)
SUCCEEDED: Final = _derivation(
    jobs.SUCCEEDED,
    stage="report",
    links={
        "result": f"{_PATH}/result",
        "artifacts": {
            name: f"{_PATH}/artifacts/{name}"
            for name in ("report.html", "report.pdf", "result.json")
        },
    },
)

ACCEPTED: Final = {"queued": QUEUED}
ENDED: Final = {"succeeded": SUCCEEDED}
PAGE: Final[dict[str, Any]] = {"derivations": [SUCCEEDED], "next": None}


def _files(**sizes: int) -> list[dict[str, Any]]:
    """Files by their names, ``__`` standing for the dot."""
    return [
        {
            "name": name.replace("__", "."),
            "media_type": MEDIA_TYPES[name.rpartition("__")[2]],
            "size": size,
            "sha256": "d749f854970d25e805a6f10b7ec3a75d2b0060b9eb3333653b6c95baa7a1608c",
        }
        for name, size in sizes.items()
    ]


MEDIA_TYPES: Final = {
    "glb": "model/gltf-binary",
    "html": "text/html",
    "pdf": "application/pdf",
    "png": "image/png",
    "webp": "image/webp",
}


def _picture(number: int, fit_id: str) -> dict[str, Any]:
    """What a fit found, for one of several pictures."""
    same = ("outcome", "image_camera", "body", "light", "reflectance", "silhouette_overlap")
    return {"number": number, "fit_id": fit_id} | {name: RESULT[name] for name in same}


REPORT_RESULT: Final[dict[str, Any]] = {
    "artifacts": _files(report__html=653350, report__pdf=786326),
    "kind": "report",
}

RESULTS: Final[dict[str, Any]] = {
    "report": REPORT_RESULT,
    "caricature": {
        "artifacts": _files(body_caricature__glb=699740, caricature__png=238067),
        "kind": "caricature",
        "factor": 2.5,
        "coefficient": 2,
        "before": -1.711,
        "after": -4.278,
        "height_m": 1.804,
        "shape": [0.813, -1.386, -4.278],
    },
    "pose": {
        "artifacts": _files(body_reposed__glb=699656, pose__png=160197),
        "kind": "pose",
        "pose": [
            {"part": "pelvis", "rotation": [0.0, 0.0, 0.0]},
            {"part": "spine", "rotation": [0.105, 0.0, 0.0]},
        ],
    },
    "combined": {
        "artifacts": _files(
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
            _picture(1, str(jobs.FIT_ID)),
            _picture(2, "0d3c1b6e-52a4-4f0e-9e37-0a4f6c2f7d10"),
        ],
        "measurements": [RESULT["measurements"][-1]],
        "agreement": 0.84,
        "warnings": [],
    },
    "figure": {
        "artifacts": _files(figure__png=912000),
        "kind": "figure",
        "pose": "arms_raised",
    },
    "texture": {
        "artifacts": _files(
            body_textured__glb=2874000,
            texture__png=1980000,
            coverage__png=21000,
            atlas__png=73000,
        ),
        "kind": "texture",
        "colours": "albedo",
        "size": 2048,
        "seen_share": 0.38,
        "mirrored_share": 0.09,
        "scale": 1.0,
    },
    "animation": {
        "artifacts": _files(body_animated__glb=4321000, animation__webp=151000),
        "kind": "animation",
        "source": "the walk that ships with the package",
        "frames": 99,
        "frame_time_s": 0.0334,
        "morph_targets": 12,
        "morph_mean_error_mm": 0.4,
        "morph_largest_error_mm": 2.9,
        "skin_mean_error_mm": 3.1,
        "skin_largest_error_mm": 41.0,
        "sliding_mm": 0.6,
        "travelled_m": 4.1,
        "warnings": [],
    },
}

NOTICE: Final[dict[str, Any]] = {
    "type": "derivation.succeeded",
    "timestamp": SUCCEEDED["finished_at"],
    "data": SUCCEEDED,
}
