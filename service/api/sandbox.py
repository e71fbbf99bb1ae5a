"""What a sandbox is asked to make of a job, on its way into the job's inputs."""

from service.api.context import ApiContext
from service.api.job_inputs import File
from service.engine.port import JobRecord
from service.jobs.inputs import SANDBOX
from service.jobs.sandbox import Whose
from service.submissions.sandbox_labels import asked_ending


def asked_of_job(context: ApiContext, label: str | None) -> dict[str, File]:
    """The input that tells the worker how a fit or scan of this label is to end, if it asks.

    A token's label goes before that of the request. There is none where this is no sandbox.

    Raises
    ------
    RefusedError
        If there is no such ending.
    """
    if context.token is not None and context.token.label is not None:
        label = context.token.label
    return _asked(context, label, Whose.PICTURES)


def asked_of_derivation(context: ApiContext, parent: JobRecord) -> dict[str, File]:
    """The same of what is derived from a fit or scan, whose label says so."""
    return _asked(context, parent.label, Whose.DERIVATIONS)


def check_label(context: ApiContext, label: str | None) -> None:
    """Refuse a label that asks for an ending that there is not; as :func:`asked_of_job`."""
    _asked(context, label, Whose.PICTURES)


def _asked(context: ApiContext, label: str | None, whose: Whose) -> dict[str, File]:
    if not context.settings.sandbox:
        return {}
    ending = asked_ending(label, whose)
    return {} if ending is None else {SANDBOX: _file(ending)}


def _file(ending: str) -> File:
    return File(content=ending.encode(), media_type="text/plain")
