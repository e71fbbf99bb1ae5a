"""Questions to a service and its answers, kept as examples that come out the same each time.

Of long lists the beginning is kept. Ids, times, secrets and digests are always the same, so that
what is answered twice alike is said once in the document.
"""

import json
import re
import time
from typing import Any

import httpx

from tests.contract.document import exported, operations
from tests.integration.service.receiver import Receiver

SHOWN = "https://example.org/hooks/maquette"
"""Stands for the address that notices are really sent to."""

FIT = "b0d3cd76-33ef-4c01-b18c-190159d7df68"
"""The id that stands for that of any fit."""

UUID = r"[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12}"
MOMENT = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(?:\.\d+)?(?=Z)")
SAME: tuple[tuple[str, str], ...] = (
    (r'(?<="expires_at": ")[^"]+', "2026-05-11T09:30:05.995Z"),
    (r"http://127\.0\.0\.1:\d+/\w*", SHOWN),
    (r"cursor=\d+\.\d+-", "cursor=1777887000.995-"),
    (
        r"(?<=\"sha256\": \")[0-9a-f]{64}",
        "d749f854970d25e805a6f10b7ec3a75d2b0060b9eb3333653b6c95baa7a1608c",
    ),
)

FIGURE = re.compile(r"\d+(?:\.\d+)?(?:e-?\d+)?")
PASSING = ("stage", "progress", "view")

SHOWN_EVENTS = 4
"""How to retry, that the fit waits and runs, and where it is first."""

MOST_ITEMS = 4
SHORTENED = 2
ONE_IS_ENOUGH = ("bodies", "limb_facing", "limbs", "models", "stages")
MAPS = ("points", "pose", "residual_px")
"""Objects whose names are many: the first is kept."""


class Recorder:
    """Asks a service, and keeps questions and answers by operation."""

    def __init__(self, client: httpx.Client, receiver: Receiver) -> None:
        self.requests: dict[str, dict[str, Any]] = {}
        self.answers: dict[str, dict[str, dict[str, Any]]] = {}
        self.notices: dict[str, Any] = {}
        self._client = client
        self._receiver = receiver
        self._operations = [
            (each.method, re.compile(re.sub(r"\{\w+\}", "[^/]+", each.path)), each.id)
            for each in operations(exported())
        ]

    def ask(
        self, shown_as: str, method: str, path: str, *, asked_as: str = "", **sent: Any
    ) -> httpx.Response:
        """Ask, and keep the answer under a name, and what was asked if it has one too."""
        operation = next(
            name
            for verb, pattern, name in self._operations
            if verb == method.lower() and pattern.fullmatch(path.partition("?")[0])
        )
        if asked_as:
            self.requests.setdefault(operation, {})[asked_as] = sent["json"]
        if "json" in sent:
            real = json.dumps(sent["json"]).replace(SHOWN, self._receiver.url())
            sent["json"] = json.loads(real)
        answer = self._client.request(method, path, **sent)
        assert answer.is_success, answer.text
        if shown_as:
            kept = self.answers.setdefault(operation, {}).setdefault(str(answer.status_code), {})
            kind = answer.headers["content-type"].partition(";")[0]
            said = answer.json() if kind == "application/json" else answer.text
            said = _first_and_last(said) if kind == "text/event-stream" else said
            kept.setdefault(shown_as, self._shown(said))
        return answer

    def until_ended(self, path: str) -> dict[str, Any]:
        """Wait for the end of a fit."""
        return self.until(path, lambda fit: fit["state"] not in ("queued", "running"))

    def until(self, path: str, is_so: Any) -> dict[str, Any]:
        """Look at a fit until it is as it should be."""
        while not is_so(fit := self._client.get(path).raise_for_status().json()):
            time.sleep(0.05)
        return fit

    def take_notice(self, name: str) -> None:
        """Keep the next notice."""
        while not self._receiver.notices:
            time.sleep(0.05)
        self.notices[name] = self._shown(self._receiver.notices.pop(0).event)

    def _shown(self, value: Any) -> Any:
        """The value as an example: short, and with ids and times that are always the same."""
        text = json.dumps(_short(value))
        for found in re.findall(rf"/fits/({UUID})", text):
            text = text.replace(found, FIT)
        for second, moment in enumerate(sorted(set(MOMENT.findall(text)))):
            text = text.replace(f"{moment}Z", f"2026-05-04T09:30:{second:02}.995Z")
        for pattern, same in SAME:
            text = re.sub(pattern, same, text)
        return json.loads(text)


def _first_and_last(stream: str) -> str:
    """A stream of events without most of those that tell of progress."""
    events = stream.removesuffix("\n\n").split("\n\n")
    return "\n\n".join((*events[:SHOWN_EVENTS], events[-1])) + "\n\n"


def _short(value: Any, name: str = "") -> Any:
    if isinstance(value, float):
        return float(f"{value:.4g}")
    if isinstance(value, list):
        kept = value if len(value) <= MOST_ITEMS else value[:SHORTENED]
        kept = kept[:1] if name in ONE_IS_ENOUGH else kept
        return [_short(each) for each in kept]
    if isinstance(value, dict):
        items = list(value.items())
        if name in MAPS:
            items = items[:1]
        if name == "files":
            items = items[:SHORTENED]
        return {key: _short(each, key) for key, each in items}
    return value


def differences(recorded: Any, shown: Any, where: str = "") -> list[str]:
    """Where what was recorded is otherwise than what is shown, but for figures.

    A machine computes other last digits, needs other times and writes files of other sizes; how far
    a fit has come when it is looked at is chance.
    """
    if isinstance(recorded, dict) and isinstance(shown, dict):
        names = recorded.keys() | shown.keys()
        if recorded.keys() != shown.keys():
            return [f"{where}: {sorted(recorded.keys() ^ shown.keys())}"]
        chance = PASSING if recorded.get("state") == "running" else ()
        return [
            each
            for name in sorted(names - set(chance))
            for each in differences(recorded[name], shown[name], f"{where}.{name}")
        ]
    if isinstance(recorded, list) and isinstance(shown, list):
        if len(recorded) != len(shown):
            return [f"{where}: {len(recorded)} items, not {len(shown)}"]
        pairs = enumerate(zip(recorded, shown, strict=True))
        return [each for number, pair in pairs for each in differences(*pair, f"{where}.{number}")]
    if _is_figure(recorded) and _is_figure(shown):
        return []
    if isinstance(recorded, str) and isinstance(shown, str):
        recorded, shown = (FIGURE.sub("0", each) for each in (recorded, shown))
    return [] if recorded == shown else [f"{where}: {recorded!r}, not {shown!r}"]


def _is_figure(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
