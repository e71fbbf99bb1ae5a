"""Every setting of the service, once. Built in the entry point and passed down."""

import ipaddress
import os
import re
from pathlib import Path
from typing import Final, Literal
from urllib.parse import urlsplit

from pydantic import Field, ValidationInfo, field_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from api_schemas.webhooks import secret_key

PREFIX: Final = "MAQUETTE_"


class SettingError(Exception):
    """A setting cannot be followed; found out only when it was tried."""

    def __init__(self, reason: str, *, name: str) -> None:
        super().__init__(f"{PREFIX}{name.upper()}: {reason}")
        self.name = name
        self.reason = reason


class Settings(BaseSettings):
    """Read from environment variables named ``MAQUETTE_`` and the field's name in capitals."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True, extra="forbid")

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
    cors_origins: str = Field(
        default="",
        description="Origins whose pages may call the API from a browser, separated by commas.",
    )
    data_dir: Path = Field(
        default=Path("maquette-data"),
        description="Folder of the embedded database, the pictures and the results.",
    )
    database_url: str | None = Field(
        default=None,
        description="`postgresql://...` for several machines; SQLite in the data folder if unset.",
    )
    blob_url: str | None = Field(
        default=None,
        description=(
            "`s3://bucket/prefix` for pictures and results in object storage (credentials from "
            "`AWS_ACCESS_KEY_ID` and so on); the data folder if unset."
        ),
    )
    s3_endpoint_url: str | None = Field(
        default=None, description="Address of an S3-compatible server; Amazon's own if unset."
    )
    s3_region: str | None = Field(
        default=None,
        description="Region of the bucket; the S3 client's own if unset.",
    )
    models_dir: Path | None = Field(
        default=None,
        description="Folder with `female.npz` and `male.npz`; the packaged body models if unset.",
    )
    max_upload_bytes: int = Field(
        default=50_000_000, ge=1, description="Largest request body accepted."
    )
    max_pixels: int = Field(
        default=50_000_000, ge=1, description="Largest picture accepted, in pixels."
    )
    max_queued: int = Field(
        default=1_000, ge=1, description="Jobs that may wait before new ones are refused (503)."
    )
    max_queued_per_tenant: int = Field(
        default=200,
        ge=1,
        description="Jobs of one tenant that may wait before its new ones are refused (429).",
    )
    max_images_per_tenant: int = Field(
        default=1_000,
        ge=1,
        description="Uploaded pictures kept for one tenant before more are refused (507).",
    )
    max_image_bytes_per_tenant: int = Field(
        default=5_000_000_000,
        ge=1,
        description="Bytes of uploaded pictures kept for one tenant before more are refused (507).",
    )
    requests_per_minute: int = Field(
        default=1_200,
        ge=1,
        description="Requests of one API key, at each API process, before it is refused (429).",
    )
    retention_hours: float = Field(
        default=168.0,
        gt=0.0,
        description="A job is erased, with its picture and results, this long after its end.",
    )
    sweep_interval_s: float = Field(
        default=60.0, gt=0.0, description="How often what has expired is looked for and erased."
    )
    webhook_secret: str | None = Field(
        default=None,
        repr=False,
        description=(
            "`whsec_` and the base64 of 24 to 64 random bytes: signs the notices of fits that "
            "bring no secret of their own; those are refused if unset."
        ),
    )
    webhook_hosts: str = Field(
        default="",
        description=(
            "Hosts, separated by commas, that notices may be sent to even if their addresses are "
            "not public: for development and for receivers on the same network."
        ),
    )
    webhook_time_limit_s: float = Field(
        default=15.0, gt=0.0, description="How long one attempt to send a notice may take."
    )
    webhook_pauses_s: str = Field(
        default="5,300,1800,7200,18000,36000,50400,72000,86400",
        description=(
            "Seconds between the attempts to send a notice, separated by commas; after the last "
            "attempt it is given up."
        ),
    )
    worker_processes: int = Field(
        default_factory=lambda: os.cpu_count() or 1,
        ge=1,
        description="Fits one worker runs side by side; the number of CPU cores if unset.",
    )
    estimator_processes: int = Field(
        default=1,
        ge=1,
        description=(
            "Processes beside the API that answer bodies and initial poses, one question at a time "
            "each; about 400 MB each."
        ),
    )
    job_time_limit_s: float = Field(
        default=600.0, gt=0.0, description="A fit is stopped after this many seconds."
    )
    max_crashes: int = Field(
        default=3, ge=1, description="A job whose process died this often is given up."
    )
    child_memory_mb: int = Field(
        default=4_096, ge=256, description="Address space of the process that makes one fit."
    )
    drain_s: float = Field(
        default=20.0,
        ge=0.0,
        description="How long a stopping worker waits for its fits before handing them back.",
    )
    stop_delay_s: float = Field(
        default=0.0,
        ge=0.0,
        description=(
            "How long a stopping API still answers while it reports itself not ready, so that a "
            "load balancer can turn away from it."
        ),
    )
    heartbeat_s: float = Field(
        default=2.0, gt=0.0, description="How often a worker says that it is alive."
    )
    dead_after_s: float = Field(
        default=15.0, gt=0.0, description="A worker silent for this long has its fits taken over."
    )
    queue_poll_s: float = Field(
        default=0.1, gt=0.0, description="How often an idle worker looks for jobs."
    )
    cancel_poll_s: float = Field(
        default=0.1, gt=0.0, description="How often a running fit looks whether it was canceled."
    )
    progress_interval_s: float = Field(
        default=0.2, gt=0.0, description="The shortest time between two stored progress reports."
    )
    min_free_disk_mb: int = Field(
        default=200, ge=0, description="With less free disk the service reports itself not ready."
    )
    log_level: Literal["DEBUG", "INFO", "WARNING", "ERROR"] = Field(
        default="INFO", description="DEBUG, INFO, WARNING or ERROR."
    )
    log_format: Literal["text", "json"] = Field(
        default="text", description="`json` for one object a line, `text` for people."
    )
    traces_endpoint: str | None = Field(
        default=None,
        description=(
            "Address of an OTLP/HTTP collector (`http://host:4318`) to send traces to; none are "
            "made if unset."
        ),
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

    @field_validator("webhook_secret")
    @classmethod
    def _is_a_usable_secret(cls, secret: str | None) -> str | None:
        if secret is not None:
            secret_key(secret)
        return secret

    @field_validator("webhook_pauses_s")
    @classmethod
    def _are_pauses(cls, pauses: str) -> str:
        if not all(re.fullmatch(r"\s*\d{1,6}(\.\d+)?\s*", each) for each in pauses.split(",")):
            message = "write seconds separated by commas, as in 5,300,1800"
            raise ValueError(message)
        return pauses

    @field_validator("blob_url")
    @classmethod
    def _is_a_bucket(cls, url: str | None) -> str | None:
        if url is not None and (urlsplit(url).scheme != "s3" or not urlsplit(url).netloc):
            message = "write it as s3://bucket or s3://bucket/prefix"
            raise ValueError(message)
        return url

    @field_validator("cors_origins")
    @classmethod
    def _are_origins(cls, origins: str) -> str:
        for origin in split_list(origins):
            parts = urlsplit(origin)
            if (
                parts.scheme not in ("http", "https")
                or origin != f"{parts.scheme}://{parts.netloc}"
            ):
                message = (
                    f"{origin!r} is no origin; write scheme, host and port, as in https://host"
                )
                raise ValueError(message)
        return origins

    @field_validator("models_dir")
    @classmethod
    def _both_models_are_there(cls, folder: Path | None) -> Path | None:
        for name in ("female.npz", "male.npz"):
            if folder is not None and not (folder / name).is_file():
                message = f"no {name} in {folder}: train one, or copy the packaged one there"
                raise ValueError(message)
        return folder

    @property
    def system_database_url(self) -> str:
        """The database of jobs: the one named, or the embedded one."""
        return self.database_url or f"sqlite:///{self.data_dir.resolve() / 'maquette.sqlite'}"

    @property
    def allowed_origins(self) -> tuple[str, ...]:
        """Origins of other sites whose pages may call the API."""
        return split_list(self.cors_origins)

    @property
    def allowed_webhook_hosts(self) -> tuple[str, ...]:
        """Hosts that notices may be sent to wherever they are."""
        return split_list(self.webhook_hosts.lower())

    @property
    def webhook_schedule_s(self) -> tuple[float, ...]:
        """The pauses between the attempts to send a notice."""
        return tuple(float(pause) for pause in split_list(self.webhook_pauses_s))

    @property
    def tenant_queue_limit(self) -> int:
        """How many jobs of one tenant may wait; the sole tenant's are all there are."""
        return self.max_queued if self.authentication == "off" else self.max_queued_per_tenant

    @property
    def retention_s(self) -> float:
        """How long an ended job is kept."""
        return self.retention_hours * 3600.0

    @property
    def blob_dir(self) -> Path:
        """The folder of pictures and results."""
        return self.data_dir.resolve() / "blobs"

    def environment(self) -> dict[str, str]:
        """Write these settings as the environment of another process that is to share them."""
        values = self.model_dump(mode="json", exclude_none=True)
        return {f"{PREFIX}{name.upper()}": str(value) for name, value in values.items()}


def is_loopback(host: str) -> bool:
    """Say whether an address, or the name ``localhost``, is reached from this machine only."""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost"


def split_list(text: str) -> tuple[str, ...]:
    """Read a list separated by commas."""
    return tuple(each.strip() for each in text.split(",") if each.strip())
