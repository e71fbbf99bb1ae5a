"""Every setting of the service, once. Built in the entry point and passed down.

One table, however long: each setting stands with its bounds and what it means.
"""

import ipaddress
import os
from pathlib import Path
from typing import Annotated, Final, Literal
from urllib.parse import urlsplit

from pydantic import (
    AnyUrl,
    BeforeValidator,
    DirectoryPath,
    Field,
    StringConstraints,
    UrlConstraints,
    ValidationInfo,
    field_validator,
)
from pydantic_settings import BaseSettings, NoDecode, SettingsConfigDict

from api_schemas.jobs import WebhookSecret

PREFIX: Final = "MAQUETTE_"

DAY_S: Final = 86_400.0
SHORTEST_PACE_S: Final = 0.01
"""Shortest interval of repeated work, seconds; shorter ones take a processor for themselves."""

LONGEST_RETENTION_HOURS: Final = 87_600.0
"""Ten years."""

LARGEST_BODY_BYTES: Final = 2_000_000_000
"""A body is held in memory."""

MOST_PROCESSES: Final = 1_024
SILENT_BEATS: Final = 2.0
"""Heartbeats that may at least go missing before a worker is taken for dead."""


POSTGRES: Final = "postgresql"
NOT_SHOWN: Final = "(not shown)"

DatabaseUrl = Annotated[
    AnyUrl, UrlConstraints(allowed_schemes=[POSTGRES, "postgres", "postgresql+psycopg"])
]
"""All these names of the scheme mean the first."""

BucketUrl = Annotated[
    str, StringConstraints(pattern=r"^s3://[A-Za-z0-9][A-Za-z0-9._-]{1,253}[A-Za-z0-9](/[^?#]*)?$")
]
"""Some server takes such a name: old buckets of Amazon's are longer, or have capitals and _."""


def _split_list(value: object) -> object:
    if not isinstance(value, str):
        return value
    return tuple(each.strip() for each in value.split(",") if each.strip())


_Listed = BeforeValidator(_split_list)
Origin = Annotated[str, StringConstraints(pattern=r"^https?://[^/?#\s]+$")]
HostName = Annotated[
    str, StringConstraints(pattern=r"^([^:/@\s]+|[^:/@\s]*:[^/@\s]*:[^/@\s]*)$", to_lower=True)
]
"""A name or an address, without scheme and port."""


def is_loopback(host: str) -> bool:
    """Say whether an address, or the name ``localhost``, is reached from this machine only."""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost"


def without_secrets(url: str) -> str:
    """Write an address without password and query; nothing of one that cannot be read."""
    try:
        parts = urlsplit(url)
        # Only now it is looked at, and may be no number.
        _ = parts.port
    except ValueError:
        return NOT_SHOWN
    if "://" not in url:
        return NOT_SHOWN
    user, at, host = parts.netloc.rpartition("@")
    name, colon, _ = user.partition(":")
    hidden = f"{name}:***" if colon else name
    return f"{parts.scheme}://{hidden}{at}{host}{parts.path}"


class SettingError(Exception):
    """A setting cannot be followed; found out only when it was tried.

    The message is one line: the variable, its ``value`` without secrets, and the reason with what
    to do.
    """

    def __init__(self, reason: str, *, name: str, value: object) -> None:
        super().__init__(f"{PREFIX}{name.upper()}={value}: {reason}")


class Settings(BaseSettings):
    """Read from environment variables named ``MAQUETTE_`` and the field's name in capitals."""

    model_config = SettingsConfigDict(
        env_prefix=PREFIX,
        env_ignore_empty=True,
        frozen=True,
        extra="forbid",
        allow_inf_nan=False,
    )

    host: str = Field(default="127.0.0.1", description="Address the API listens on.")
    port: int = Field(default=8000, ge=0, le=65535, description="Port the API listens on.")
    authentication: Literal["off", "keys"] = Field(
        default="off",
        validate_default=True,
        description=(
            "`keys`: every request needs an API key (`maquette keys create`). `off`: no keys, one "
            "tenant, and the service listens on loopback addresses only."
        ),
    )
    cors_origins: Annotated[tuple[Origin, ...], NoDecode, _Listed] = Field(
        default=(),
        description="Origins whose pages may call the API from a browser, separated by commas.",
    )
    data_dir: Path = Field(
        default=Path("maquette-data"),
        description="Folder of the embedded database, the pictures and the results.",
    )
    database_url: DatabaseUrl | None = Field(
        default=None,
        repr=False,
        description="`postgresql://...` for several machines; SQLite in the data folder if unset.",
    )
    blob_url: BucketUrl | None = Field(
        default=None,
        description=(
            "`s3://bucket/prefix` for pictures and results in object storage (server, region and "
            "credentials from `AWS_ENDPOINT_URL_S3`, `AWS_DEFAULT_REGION`, `AWS_ACCESS_KEY_ID` and "
            "so on); the data folder if unset."
        ),
    )
    models_dir: DirectoryPath | None = Field(
        default=None,
        description="Folder with `female.npz` and `male.npz`; the packaged body models if unset.",
    )
    detector_dir: DirectoryPath | None = Field(
        default=None,
        description=(
            "Folder with `pose_detection.tflite`, `pose_landmark_full.tflite` and "
            "`face_detection_short_range.tflite`, which propose points; those of the package "
            "mediapipe if unset, and none if that is not installed."
        ),
    )
    max_upload_bytes: int = Field(
        default=50_000_000,
        ge=1,
        le=LARGEST_BODY_BYTES,
        description="Largest request body accepted.",
    )
    max_pixels: int = Field(
        default=200_000_000,
        ge=1,
        le=1_000_000_000,
        description=(
            "Largest JPEG accepted, in pixels; of other pictures and of masks no more than "
            "51,000,000 are."
        ),
    )
    max_queued: int = Field(
        default=1_000,
        ge=1,
        le=1_000_000,
        description=(
            "Jobs that may wait before new ones are refused (503); a fit counts once for every "
            "picture."
        ),
    )
    max_queued_per_tenant: int = Field(
        default=200,
        ge=1,
        le=1_000_000,
        description="Jobs of one tenant that may wait before its new ones are refused (429).",
    )
    max_image_bytes_per_tenant: int = Field(
        default=5_000_000_000,
        ge=1,
        le=1_000_000_000_000_000,
        description="Bytes of uploaded pictures kept for one tenant before more are refused (507).",
    )
    requests_per_minute: int = Field(
        default=1_200,
        ge=1,
        le=1_000_000,
        description="Requests of one API key a minute before one API process refuses more (429).",
    )
    body_time_limit_s: float = Field(
        default=30.0,
        ge=SHORTEST_PACE_S,
        le=3_600.0,
        description=(
            "How long the body of a request may take (408), and a second more for every 4 kB of it."
        ),
    )
    retention_hours: float = Field(
        default=168.0,
        gt=0.0,
        le=LONGEST_RETENTION_HOURS,
        description="A job is erased, with its picture and results, this long after its end.",
    )
    sweep_interval_s: float = Field(
        default=60.0,
        ge=SHORTEST_PACE_S,
        le=DAY_S,
        description="How often what has expired is looked for and erased.",
    )
    webhook_secret: WebhookSecret | None = Field(
        default=None,
        repr=False,
        description=(
            "`whsec_` and the base64 of 24 to 64 random bytes: signs the notices of fits that "
            "bring no secret of their own; those are refused if unset."
        ),
    )
    webhook_hosts: Annotated[tuple[HostName, ...], NoDecode, _Listed] = Field(
        default=(),
        description=(
            "Hosts, separated by commas, that notices may be sent to at any port, even if their "
            "addresses are not public: for development and for receivers on the same network."
        ),
    )
    worker_processes: int = Field(
        default_factory=lambda: os.cpu_count() or 1,
        ge=1,
        le=MOST_PROCESSES,
        description="Fits one worker runs side by side; the number of CPU cores if unset.",
    )
    estimator_processes: int = Field(
        default=1,
        ge=1,
        le=MOST_PROCESSES,
        description=(
            "Processes beside the API that answer bodies and initial poses, propose points and "
            "write other formats, one question at a time each; about 110 MB each, and 210 for what "
            "they share where no worker runs."
        ),
    )
    job_time_limit_s: float = Field(
        default=600.0,
        ge=SHORTEST_PACE_S,
        le=DAY_S,
        description="A fit is stopped after this many seconds.",
    )
    max_crashes: int = Field(
        default=3,
        ge=1,
        le=1_000_000,
        description="A job whose process died this often is given up.",
    )
    child_memory_mb: int = Field(
        default=4_096,
        ge=256,
        le=1_048_576,
        description="Address space of the process that makes one fit.",
    )
    drain_s: float = Field(
        default=20.0,
        ge=0.0,
        le=DAY_S,
        description="How long a stopping worker waits for its fits before handing them back.",
    )
    stop_delay_s: float = Field(
        default=0.0,
        ge=0.0,
        le=3_600.0,
        description=(
            "How long a stopping API still answers while it reports itself not ready, so that a "
            "load balancer can turn away from it."
        ),
    )
    heartbeat_s: float = Field(
        default=2.0,
        ge=SHORTEST_PACE_S,
        le=3_600.0,
        description="How often a worker says that it is alive.",
    )
    dead_after_s: float = Field(
        default=15.0,
        ge=SHORTEST_PACE_S,
        le=DAY_S,
        description="A worker silent for this long has its fits taken over.",
    )
    min_free_disk_mb: int = Field(
        default=200,
        ge=0,
        le=1_000_000_000,
        description=(
            "With less free disk the service is not ready, refuses new work (507) and begins no "
            "job that waits."
        ),
    )
    log_level: Literal["DEBUG", "INFO", "WARNING", "ERROR"] = Field(
        default="INFO", description="DEBUG, INFO, WARNING or ERROR."
    )
    log_format: Literal["text", "json"] = Field(
        default="text", description="`json` for one object a line, `text` for people."
    )

    @field_validator("authentication")
    @classmethod
    def _open_to_this_machine_only(cls, authentication: str, info: ValidationInfo) -> str:
        host = str(info.data.get("host", ""))
        if authentication == "off" and host and not is_loopback(host):
            message = (
                f"without API keys the service listens on this machine only, not on {host}: set "
                f"{PREFIX}AUTHENTICATION=keys and create a key with `maquette keys create`, or "
                "leave the host at 127.0.0.1"
            )
            raise ValueError(message)
        return authentication

    @field_validator("dead_after_s")
    @classmethod
    def _outlasts_heartbeats(cls, dead_after_s: float, info: ValidationInfo) -> float:
        heartbeat_s = info.data.get("heartbeat_s", 0.0)
        if dead_after_s < SILENT_BEATS * heartbeat_s:
            message = (
                f"with a heart that beats every {heartbeat_s:g} s ({PREFIX}HEARTBEAT_S) every "
                f"worker would be taken for dead: set at least {SILENT_BEATS * heartbeat_s:g}"
            )
            raise ValueError(message)
        return dead_after_s

    @property
    def uses_data_folder(self) -> bool:
        """Whether anything is kept in the data folder."""
        return self.database_url is None or self.blob_url is None

    @property
    def database_file(self) -> Path:
        """Path of the embedded database, if there is one."""
        return self.data_dir.resolve() / "maquette.sqlite"

    @property
    def system_database_url(self) -> str:
        """The database of jobs: the one named, or the embedded one."""
        if self.database_url is None:
            return f"sqlite:///{self.database_file}"
        return POSTGRES + str(self.database_url).removeprefix(self.database_url.scheme)

    @property
    def tenant_queue_limit(self) -> int:
        """Number of jobs of one tenant that may wait; the sole tenant's are all there are."""
        return self.max_queued if self.authentication == "off" else self.max_queued_per_tenant

    @property
    def retention_s(self) -> float:
        """Time that an ended job is kept, seconds."""
        return self.retention_hours * 3600.0

    @property
    def blob_dir(self) -> Path:
        """The folder of pictures and results."""
        return self.data_dir.resolve() / "blobs"

    def environment(self) -> dict[str, str]:
        """Write these settings as the environment of another process that is to share them."""
        values = self.model_dump(mode="json", exclude_none=True)
        return {
            f"{PREFIX}{name.upper()}": ",".join(value) if isinstance(value, list) else str(value)
            for name, value in values.items()
        }
