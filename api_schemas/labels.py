"""The label of a fit or a scan: what a caller calls the person, to find them again."""

import re
from typing import Annotated, Final

from pydantic import AfterValidator, Field

from api_schemas.base import refusal

LONGEST: Final = 80

# Control characters, line breaks and marks that change the direction of what follows. Joiners stay,
# which names in Persian and Hindi need.
_UNSEEN: Final = (
    r"\u0000-\u001f\u007f-\u009f\u061c\u200b\u200e\u200f\u2028-\u202e\u2060-\u206f\ufeff"
)
_SPACES: Final = r" \u00a0\u1680\u2000-\u200a\u202f\u205f\u3000"
PATTERN: Final = f"^[^{_UNSEEN}]*[^{_UNSEEN}{_SPACES}][^{_UNSEEN}]*$"
_READABLE: Final = re.compile(PATTERN)


def _readable(label: str) -> str:
    if not 1 <= len(label) <= LONGEST:
        raise refusal(
            code="wrong-length",
            reason=f"The label has {len(label)} characters.",
            remedy=f"Send 1 to {LONGEST} characters, or leave it out.",
        )
    if _READABLE.fullmatch(label) is None:
        raise refusal(
            code="unreadable-label",
            reason="The label has nothing but spaces, or characters that are not seen.",
            remedy="Use letters, digits, signs and spaces; leave out line breaks and controls.",
        )
    return label


Label = Annotated[
    str,
    AfterValidator(_readable),
    Field(json_schema_extra={"minLength": 1, "maxLength": LONGEST, "pattern": PATTERN}),
]

LABEL_OF_JOB: Final = (
    "What you call the person, for instance an id of yours: lists can be filtered by it. It is "
    "kept as it was sent, cannot be changed, and is erased with the job."
)
