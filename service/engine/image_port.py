"""What the API asks of the store of uploaded pictures."""

from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class NewImage:
    """An uploaded picture to keep; its blob, named ``id``, is in ``scope`` already.

    ``width`` and ``height`` are those of the upright picture.
    """

    id: str
    scope: str
    media_type: str
    width: int
    height: int
    size: int
    focal_length_35mm: float | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageRecord(NewImage):
    """A picture as kept; times are seconds since the epoch."""

    created_at: float
    expires_at: float


@dataclass(frozen=True, slots=True, kw_only=True)
class KeptImage:
    """The picture, and whether it is the one just brought or was there already."""

    record: ImageRecord
    is_new: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageQuota:
    """How many uploaded pictures, and how many bytes of them, are kept for one tenant."""

    images: int
    size: int


class ImageQuotaError(Exception):
    """There is no room for this picture beside the tenant's others; the message says how many."""


class TenantImages(Protocol):
    """The uploaded pictures of one tenant: no other's can be seen or touched through it.

    Every method may raise :class:`service.engine.port.EngineUnavailableError`.
    """

    def find(self, image_id: str) -> ImageRecord | None:
        """Return the picture, or None if there is none or its time is over."""
        ...

    def renew(self, image_id: str) -> ImageRecord | None:
        """Begin the picture's time anew, if there is such a picture."""
        ...

    def reserve(self, scope: str, *, size: int) -> None:
        """Say that a picture of ``size`` bytes is about to be stored in a scope.

        Should nothing come of it, the scope is erased after an hour.

        Raises
        ------
        ImageQuotaError
            If there is no room for it.
        """
        ...

    def keep(self, image: NewImage) -> KeptImage | None:
        """Keep a picture whose scope was reserved, or return the same one kept before.

        None if its scope was taken for abandoned and erased meanwhile.
        """
        ...

    def erase(self, image_id: str) -> str | None:
        """Forget the picture; returns its scope, which is the caller's to erase, if there was one.

        Should the caller not come to it, the sweep does.
        """
        ...
