"""Pictures uploaded before they are fitted."""

from datetime import datetime
from typing import Annotated, Final

from pydantic import Field

from api_schemas.base import WireModel

LEAST_SIDE_PX: Final = 64
LARGEST_ASPECT_RATIO: Final = 20.0

ImageId = Annotated[
    str,
    Field(
        pattern="^[0-9a-f]{64}$",
        description="SHA-256 of the file, as `POST /v1/images` answered it.",
        examples=["0f7cfbdf3dcb0c9ac2e2b8f1f1c4f3a63f1a1b7f0e2a5d4c3b2a19080706f5e4"],
    ),
]


class UploadedImage(WireModel):
    """An uploaded picture; the same bytes always have the same id.

    ``width`` and ``height`` are those a browser shows (EXIF orientation applied), in which points
    are counted.
    """

    id: ImageId
    media_type: str
    width: int
    height: int
    size: int = Field(description="Bytes.")
    focal_length_35mm: float | None = Field(
        description="The 35 mm equivalent its EXIF data name; null where they name none."
    )
    created_at: datetime
    expires_at: datetime | None = Field(description="When it is erased; null if it is kept.")


class ImagePage(WireModel):
    """Uploaded pictures, newest first; ``next`` is the path of the following page."""

    images: tuple[UploadedImage, ...]
    next: str | None
