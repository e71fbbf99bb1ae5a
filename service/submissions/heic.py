"""Whether HEIC pictures are decoded, for processes that may not load the decoder.

Only this machine is checked. Workers may run elsewhere with the same settings: if one of them lacks
the decoder, its fit fails with the same code.
"""

from api_schemas.problems import FieldProblem
from fitter.observation.heif import NOT_INSTALLED, NOT_INSTALLED_CODE, REMEDY, decodes_heif
from service.submissions.refusal import refused


def check_heic(field: str) -> None:
    """Refuse a HEIC picture if its decoder is not installed.

    Raises
    ------
    RefusedError
        ``heic-not-installed``.
    """
    if decodes_heif():
        return
    raise refused(
        FieldProblem(field=field, code=NOT_INSTALLED_CODE, reason=NOT_INSTALLED, remedy=REMEDY),
        slug="unsupported-media-type",
    )
