"""What the API asks of the store of uploaded pictures."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class NewImage:
    """An uploaded picture to keep; its blob, named ``id``, is already in ``scope``.

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
    """A stored picture; times are seconds since the epoch."""

    created_at: float
    expires_at: float


@dataclass(frozen=True, slots=True, kw_only=True)
class KeptImage:
    """The picture, and whether it has just been stored or was there already."""

    record: ImageRecord
    is_new: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageQuota:
    """How many uploaded pictures, and how many bytes of them, one tenant may keep."""

    images: int
    size: int


class ImageQuotaError(Exception):
    """There is no room for this picture besides the tenant's others; the message says how many."""


class TenantImages(Protocol):
    """The uploaded pictures of one tenant; those of others can be neither seen nor touched.

    Every method may raise :class:`service.engine.port.EngineUnavailableError`.
    """

    def find(self, image_id: str) -> ImageRecord | None:
        """Return the picture, or None if there is none or it has expired."""
        ...

    def images(self, *, limit: int, before: tuple[float, str] | None) -> Sequence[ImageRecord]:
        """Return pictures newest first, after the one that ``before`` names by time and id."""
        ...

    def renew(self, image_id: str) -> ImageRecord | None:
        """Restart the picture's time, if the same caller has uploaded it."""
        ...

    def reserve(self, scope: str, *, size: int) -> None:
        """Announce that a picture of ``size`` bytes is about to be stored in a scope.

        If nothing comes of it, the scope is erased after an hour.

        Raises
        ------
        ImageQuotaError
            If there is no room for the picture.
        """
        ...

    def keep(self, image: NewImage) -> KeptImage | None:
        """Keep a picture whose scope was reserved, or return the same one kept before.

        None if its scope was considered abandoned and has been erased meanwhile.
        """
        ...

    def erase(self, image_id: str) -> Sequence[str]:
        """Forget the picture; returns its scopes, if any, which the caller should erase.

        If the caller does not get to it, the sweep will.
        """
        ...
