"""Optional traces: from the request to the stages of the fit, across all processes.

Only OpenTelemetry's interface is needed to make spans; without a collector to send them to they are
no-ops. The exporter is an extra (``maquette[tracing]``).
"""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any, Final

from opentelemetry import context as otel_context
from opentelemetry import trace
from opentelemetry.trace import Span, SpanKind, Status, StatusCode
from opentelemetry.trace.propagation.tracecontext import TraceContextTextMapPropagator

from service.setting_addresses import without_secrets
from service.settings import SettingError, Settings

TRACER: Final = trace.get_tracer("maquette")
_PROPAGATOR: Final = TraceContextTextMapPropagator()
_HEADER: Final = "traceparent"

Attributes = Mapping[str, str | int | float | bool]


class Tracing:
    """The export of this process's spans; ``stop`` sends what is still held."""

    def __init__(self, provider: Any | None) -> None:
        self._provider = provider

    def stop(self) -> None:
        """Send the spans that are held and stop."""
        if self._provider is not None:
            self._provider.shutdown()


def start_tracing(settings: Settings, *, role: str) -> Tracing:
    """Send this process's spans to the collector of the settings, if there is one.

    Raises
    ------
    SettingError
        If a collector is named and the exporter is not installed.
    """
    if settings.traces_endpoint is None:
        return Tracing(None)
    try:
        from opentelemetry.exporter.otlp.proto.http.trace_exporter import OTLPSpanExporter
        from opentelemetry.sdk.resources import Resource
        from opentelemetry.sdk.trace import TracerProvider
        from opentelemetry.sdk.trace.export import BatchSpanProcessor
    except ImportError as error:
        message = "traces need the exporter; install it with: pip install 'maquette[tracing]'"
        shown = without_secrets(settings.traces_endpoint)
        raise SettingError(message, name="traces_endpoint", value=shown) from error
    provider = TracerProvider(resource=Resource.create({"service.name": f"maquette-{role}"}))
    endpoint = f"{settings.traces_endpoint.rstrip('/')}/v1/traces"
    provider.add_span_processor(BatchSpanProcessor(OTLPSpanExporter(endpoint=endpoint)))
    trace.set_tracer_provider(provider)
    return Tracing(provider)


def current_traceparent() -> str | None:
    """Return the W3C traceparent of the current span, to be passed to another process."""
    carrier: dict[str, str] = {}
    _PROPAGATOR.inject(carrier)
    return carrier.get(_HEADER)


@contextmanager
def span(
    name: str,
    *,
    parent: str | None = None,
    kind: SpanKind = SpanKind.INTERNAL,
    attributes: Attributes | None = None,
) -> Iterator[Span]:
    """Make a span that lasts as long as the context, below the one a traceparent names."""
    context = _PROPAGATOR.extract({_HEADER: parent}) if parent else otel_context.get_current()
    with TRACER.start_as_current_span(
        name,
        context=context,
        kind=kind,
        attributes=dict(attributes or {}),
        # Messages of exceptions may quote what a caller sent.
        record_exception=False,
        set_status_on_exception=False,
    ) as current:
        try:
            yield current
        except Exception as error:
            current.set_status(Status(StatusCode.ERROR, type(error).__name__))
            raise


class StageSpans:
    """One span per stage, each from its first report to that of the next."""

    def __init__(self) -> None:
        self._stage: str | None = None
        self._span: Span | None = None

    def enter(self, stage: str) -> None:
        """Take a report of a stage."""
        if stage == self._stage:
            return
        self.close()
        self._stage = stage
        self._span = TRACER.start_span(stage, start_time=time.time_ns())

    def close(self) -> None:
        """End the current stage."""
        if self._span is not None:
            self._span.end()
            self._span = None
