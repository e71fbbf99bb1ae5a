"""What the root of the service answers."""

from pydantic import Field

from api_schemas.base import WireModel


class ServiceIndex(WireModel):
    """The service's name, version and ways in; ``links`` are paths below its root."""

    name: str
    version: str
    links: dict[str, str]
    retention_hours: float | None = Field(
        default=None,
        description=(
            "Hours after which a picture that is no longer used, and a job that has ended, are "
            "erased."
        ),
    )
    max_pixels: int | None = Field(
        default=None, description="Pixels of the largest picture accepted."
    )
    max_upload_bytes: int | None = Field(
        default=None, description="Bytes of the largest request accepted."
    )
    sandbox: bool = Field(
        default=False,
        description="Whether results are canned, whatever is sent: for those who develop clients.",
    )
