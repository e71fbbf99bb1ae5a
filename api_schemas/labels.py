"""Labels and names that somebody types and reads again: of a person, a size.

They are kept and shown as they were sent, so nothing may be in them that is not seen: it would make
two of them look alike, turn what follows around, or end a line of somebody's log.
"""

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
"""Pattern of labels in the OpenAPI document: as much of the rule as few characters can say."""

# Beyond that pattern: soft hyphens, fillers that look like spaces, marks of annotations,
# music and languages, and what is no character.
_BLANK: Final = (
    r"\u00ad\u115f\u1160\u17b4\u17b5\u180e\u3164\ud800-\udfff\uffa0\ufff0-\ufffb\ufffe\uffff"
    r"\U0001bca0-\U0001bca3\U0001d173-\U0001d17a\U000e0000-\U000e001f"
)
# They shape or choose what stands before them (letters, emoji, flags), and alone are nothing.
_ATTACHED: Final = r"\u034f\u180b-\u180d\u180f\u200c\u200d\u2800\ufe00-\ufe0f\U000e0020-\U000e01ef"
_READABLE: Final = re.compile(
    f"[^{_UNSEEN}{_BLANK}]*[^{_UNSEEN}{_BLANK}{_SPACES}{_ATTACHED}][^{_UNSEEN}{_BLANK}]*"
)

UNREADABLE: Final = "It has nothing but spaces, or characters that are not seen."
READABLE_REMEDY: Final = (
    "Use letters, digits, signs and spaces; leave out line breaks and controls."
)


def is_readable(text: str) -> bool:
    """Whether all of a text is seen, and not all of it is spaces."""
    return _READABLE.fullmatch(text) is not None


def _check_readable(text: str) -> str:
    if not is_readable(text):
        raise refusal(code="unreadable-label", reason=UNREADABLE, remedy=READABLE_REMEDY)
    return text


def _check_length(label: str) -> str:
    if not 1 <= len(label) <= LONGEST:
        raise refusal(
            code="wrong-length",
            reason=f"The label has {len(label)} characters.",
            remedy=f"Send 1 to {LONGEST} characters, or leave it out.",
        )
    return label


_IN_DOCUMENT: Final = Field(
    json_schema_extra={"minLength": 1, "maxLength": LONGEST, "pattern": PATTERN}
)

Label = Annotated[str, AfterValidator(_check_length), AfterValidator(_check_readable), _IN_DOCUMENT]

LABEL_OF_FIT: Final = (
    "What you call the person, for instance an id of yours: lists can be filtered by it. It is "
    "kept as it was sent, cannot be changed, and is erased with the fit."
)
