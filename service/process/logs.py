"""Logging of the entry points: one line per record, with the ids of the request and the job.

No record contains pictures, points or other personal data. An exception's message might, because it
may quote the value at fault. The database's driver and pydantic are configured not to
(``hide_parameters``, ``hide_input_in_errors``); the child process, which alone sees decoded
pictures and points, logs an unexpected exception by type and place and withholds its message.
"""

import contextlib
import json
import logging
import time
import traceback
from collections.abc import Iterator, Mapping
from contextvars import ContextVar
from types import MappingProxyType, TracebackType
from typing import Any, Final

LogContext = Mapping[str, str]

OURS: Final = ("service", "fitter", "uvicorn")
"""Loggers that follow the level they are given down to DEBUG: our own, and the server's."""

_CONTEXT: Final[ContextVar[LogContext]] = ContextVar("log_context", default=MappingProxyType({}))

_ExcInfo = tuple[type[BaseException], BaseException, TracebackType | None] | tuple[None, None, None]


def configure_logging(
    level: str, log_format: str = "text", *, withhold_messages: bool = False
) -> None:
    """Log to standard error; ``withhold_messages`` shows exceptions by type and place only."""
    formatter = _JsonFormatter if log_format == "json" else _TextFormatter
    handler = logging.StreamHandler()
    handler.setFormatter(formatter(withhold_messages=withhold_messages))
    # What libraries log at DEBUG is of no use here, and thousands of lines.
    others = max(logging.INFO, logging.getLevelNamesMapping()[level])
    logging.basicConfig(level=others, handlers=[handler], force=True)
    for ours in OURS:
        logging.getLogger(ours).setLevel(level)
    # DBOS logs every migration and launch at INFO; what matters about jobs we log ourselves.
    dbos = logging.getLogger("dbos")
    dbos.setLevel(max(logging.WARNING, logging.getLogger().level))
    # Without a handler of its own it would be given one with a format of its own.
    dbos.handlers, dbos.propagate, dbos.filters = [handler], False, [_shorten_outage]
    # These log what they send and are sent.
    for chatty in ("botocore", "boto3", "urllib3", "s3transfer", "httpx", "httpcore", "PIL"):
        logging.getLogger(chatty).setLevel(logging.WARNING)


@contextlib.contextmanager
def log_context(**ids: str | None) -> Iterator[None]:
    """Add ids to every record of this thread or task while the context lasts."""
    given = {name: value for name, value in ids.items() if value is not None}
    token = _CONTEXT.set({**_CONTEXT.get(), **given})
    try:
        yield
    finally:
        _CONTEXT.reset(token)


def current_log_context() -> LogContext:
    """Return the ids of this thread or task, to be carried into another process."""
    return _CONTEXT.get()


def fields(**values: object) -> dict[str, Any]:
    """Give a record fields of its own: ``LOG.info("Ended.", extra=fields(seconds=1.2))``."""
    return {"fields": values}


class _Formatter(logging.Formatter):
    converter = time.gmtime

    def __init__(self, *, withhold_messages: bool) -> None:
        super().__init__()
        self._withhold_messages = withhold_messages

    def formatException(self, ei: Any) -> str:  # noqa: N802
        info: _ExcInfo = ei
        if not self._withhold_messages or info[1] is None:
            return super().formatException(ei)
        return "\n".join(_without_messages(info[1]))

    def _values(self, record: logging.LogRecord) -> dict[str, object]:
        return {**_CONTEXT.get(), **getattr(record, "fields", {})}

    def _moment(self, record: logging.LogRecord) -> str:
        return f"{self.formatTime(record, '%Y-%m-%dT%H:%M:%S')}.{int(record.msecs):03d}Z"

    def _trace(self, record: logging.LogRecord) -> str:
        return self.formatException(record.exc_info) if record.exc_info else ""


class _TextFormatter(_Formatter):
    def format(self, record: logging.LogRecord) -> str:
        """Write time, level, place, message, then ``name=value`` of the fields."""
        values = "".join(f" {name}={value}" for name, value in self._values(record).items())
        line = (
            f"{self._moment(record)} {record.levelname} {record.name}: "
            f"{record.getMessage()}{values}"
        )
        trace = self._trace(record)
        return f"{line}\n{trace}" if trace else line


class _JsonFormatter(_Formatter):
    def format(self, record: logging.LogRecord) -> str:
        """Write one JSON object."""
        entry: dict[str, object] = {
            "time": self._moment(record),
            "level": record.levelname,
            "logger": record.name,
            "message": record.getMessage(),
        } | self._values(record)
        trace = self._trace(record)
        if trace:
            entry["exception"] = trace
        return json.dumps(entry, default=str, ensure_ascii=False)


def _shorten_outage(record: logging.LogRecord) -> bool:
    """Let DBOS tell in one line that the database is away, as it does every second meanwhile."""
    message = record.getMessage()
    if "OperationalError" in message and "\n" in message:
        told = [line for line in message.splitlines() if "OperationalError" in line]
        first = message.splitlines()[0].removesuffix("Traceback (most recent call last):").strip()
        record.msg = first if first in told else f"{first} {told[-1]}"
        record.args = ()
    return True


def _without_messages(error: BaseException) -> Iterator[str]:
    chained = error.__cause__ or (None if error.__suppress_context__ else error.__context__)
    if chained is not None:
        yield from _without_messages(chained)
        yield "which led to:"
    for frame in traceback.extract_tb(error.__traceback__):
        yield f"  {frame.filename}:{frame.lineno} in {frame.name}"
    yield f"{type(error).__qualname__} (message withheld)"
