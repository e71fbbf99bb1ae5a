"""Labels that ask a sandbox for an ending of a job."""

from typing import Final

from api_schemas.problems import FieldProblem
from service.jobs.sandbox import ENDINGS, FOR_DERIVATIONS, MARK, Whose, is_known
from service.submissions.refusal import RefusedError, refused


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


_PREFIXES: Final = {Whose.PICTURES: "", Whose.DERIVATIONS: FOR_DERIVATIONS}


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
