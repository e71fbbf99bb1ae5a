"""The ending that a job of a sandbox asks for by its label, stored as an input of the job."""

from typing import Final

from api_schemas.problems import FieldProblem
from service.api.context import ApiContext
from service.api.job_inputs import File
from service.engine.port import JobRecord
from service.jobs.inputs import SANDBOX
from service.jobs.sandbox import ENDINGS, FOR_DERIVATIONS, MARK, Whose, is_known
from service.submissions.refusal import RefusedError, refused

_PREFIXES: Final = {Whose.PICTURES: "", Whose.DERIVATIONS: FOR_DERIVATIONS}


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


def asked_ending(label: str | None, whose: Whose) -> str | None:
    """The ending that a label asks for, of the job itself or of what is derived from it.

    Raises
    ------
    RefusedError
        If it asks for one that there is not, of either.
    """
    if label is None or not label.startswith(MARK):
        return None
    asked = label.removeprefix(MARK)
    meant = Whose.DERIVATIONS if asked.startswith(FOR_DERIVATIONS) else Whose.PICTURES
    ending = asked.removeprefix(_PREFIXES[meant])
    if not is_known(ending, meant):
        raise _unknown(ending, meant)
    return ending if meant is whose else None


def _unknown(ending: str, whose: Whose) -> RefusedError:
    listed = ", ".join(f"{MARK}{_PREFIXES[whose]}{each}" for each in ENDINGS[whose])
    return refused(
        FieldProblem(
            field="label",
            code="unknown-ending",
            reason=f"This sandbox knows no ending '{ending}' of {whose}.",
            remedy=f"Use one of {listed}, with the seconds if slow ('{MARK}slow:5'), or a label "
            f"that does not begin with '{MARK}'.",
        )
    )
