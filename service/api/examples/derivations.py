"""Examples of derivations, of whatever kind: how they are understood, where they stand."""

from typing import Any, Final

from service.api.examples import jobs

_FIT_PATH: Final = f"/v1/fits/{jobs.FIT_ID}"
DERIVATION_ID: Final = "5f1c2a34-8b1e-4c57-9a1d-0c6f3f0f9b21"
_PATH: Final = f"{_FIT_PATH}/derivations/{DERIVATION_ID}"

TOLD_OF_ITS_END: Final[dict[str, Any]] = {
    "kind": "report",
    "webhook": {"url": "https://example.org/hooks/maquette"},
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


NOTICE: Final[dict[str, Any]] = {
    "type": "derivation.succeeded",
    "timestamp": SUCCEEDED["finished_at"],
    "data": SUCCEEDED,
}
