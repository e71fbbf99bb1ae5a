"""Every error the fitter raises.

::

    FitterError
    ├── InvalidInputError       what the caller sent cannot be used; names the field and the remedy
    ├── ModelFileError          a trained body model is missing, damaged or of another format
    ├── MeshFolderError         a user's registered meshes cannot be trained on
    ├── DetectorUnavailableError  the detector of people is not installed
    ├── DefinitionError         a measurement's place on the skin is not on the body model
    └── NumericalError          a non-finite number where none may be: a fault of ours, never hidden

Not converging is no error: it is an :class:`~fitter.result.Outcome` with its best body.
"""


class FitterError(Exception):
    """Base of all errors raised by the fitter."""


class InvalidInputError(FitterError):
    """Input that cannot be used.

    Parameters
    ----------
    code
        A stable kebab-case name, e.g. ``image-truncated``.
    field
        The request field at fault, e.g. ``image`` or ``points.left_knee``.
    reason
        What is wrong, in a sentence.
    remedy
        What the caller can do about it, in a sentence.
    largest
        The largest value that can be used, where a smaller one can be.
    """

    def __init__(
        self, *, code: str, field: str, reason: str, remedy: str, largest: float | None = None
    ) -> None:
        super().__init__(code, field, reason, remedy)
        self.code = code
        self.field = field
        self.reason = reason
        self.remedy = remedy
        self.largest = largest

    def __str__(self) -> str:
        return f"{self.field}: {self.reason} {self.remedy}"

    def within(self, place: str) -> "InvalidInputError":
        """The same fault of something that lies at ``place`` of the request, e.g. ``views.1``."""
        return InvalidInputError(
            code=self.code,
            field=f"{place}.{self.field}",
            reason=self.reason,
            remedy=self.remedy,
            largest=self.largest,
        )


class ModelFileError(FitterError):
    """A body model file that cannot be loaded.

    Parameters
    ----------
    file
        Its name.
    field
        The field at fault, such as ``mirror`` or ``header.gender``, or ``the file``.
    reason
        What was found where what was expected; goes on from the field and has no full stop.
    remedy
        What to do, in a sentence.
    """

    def __init__(self, *, file: str, field: str, reason: str, remedy: str) -> None:
        super().__init__(file, field, reason, remedy)
        self.file = file
        self.field = field
        self.reason = reason
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.file}: {self.field} {self.reason}. {self.remedy}"


class MeshFolderError(FitterError):
    """A folder of registered meshes that cannot be trained on.

    Parameters
    ----------
    place
        The file in the folder, with the entry at fault after a colon where it has entries.
    reason
        What was found where what was expected; goes on from the place and has no full stop.
    remedy
        What to do, in a sentence.
    """

    def __init__(self, *, place: str, reason: str, remedy: str) -> None:
        super().__init__(place, reason, remedy)
        self.place = place
        self.reason = reason
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.place} {self.reason}. {self.remedy}"


class DetectorUnavailableError(FitterError):
    """The detector of people is not installed, or its weights are other than those measured.

    Parameters
    ----------
    reason, remedy
        A sentence each.
    """

    def __init__(self, *, reason: str, remedy: str) -> None:
        super().__init__(reason, remedy)
        self.reason = reason
        self.remedy = remedy

    def __str__(self) -> str:
        return f"{self.reason} {self.remedy}"


class DefinitionError(FitterError):
    """A measurement's place on the skin is not on the body model."""


class NumericalError(FitterError):
    """A computation produced a value that is not finite."""
