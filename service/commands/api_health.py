"""``maquette health``: run in an API container every few seconds, so it loads nothing heavy."""

import http.client
import json
import sys
from typing import Final

from service.settings import Settings

TIMEOUT_S: Final = 4.0
UNHEALTHY: Final = 1
"""The only exit status that Docker takes as unhealthy."""


def api_health(settings: Settings) -> int:
    """Ask the API of these settings whether it is ready."""
    host = {"0.0.0.0": "127.0.0.1", "::": "::1"}.get(settings.host, settings.host)
    connection = http.client.HTTPConnection(host, settings.port, timeout=TIMEOUT_S)
    try:
        connection.request("GET", "/healthz/ready")
        answer = connection.getresponse()
        body = answer.read()
    except (OSError, http.client.HTTPException) as error:
        return unhealthy(f"no answer ({type(error).__name__})")
    finally:
        connection.close()
    if answer.status != http.client.OK:
        return unhealthy(f"{answer.status} {_code(body)}")
    return 0


def unhealthy(reason: str) -> int:
    """Print the reason, and return the exit status for it."""
    print(f"maquette health: {reason}", file=sys.stderr)
    return UNHEALTHY


def _code(body: bytes) -> str:
    """Return the code of a problem, or an empty string if it is not one of ours."""
    try:
        return str(json.loads(body)["code"])
    except (ValueError, LookupError, TypeError):
        return ""
