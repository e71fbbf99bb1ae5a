"""Every setting of the service, once. Built in the entry point and passed down."""

import os
from pathlib import Path
from typing import Final

from pydantic import Field
from pydantic_settings import BaseSettings, SettingsConfigDict

PREFIX: Final = "MAQUETTE_"


class Settings(BaseSettings):
    """Read from environment variables named ``MAQUETTE_`` and the field's name in capitals."""

    model_config = SettingsConfigDict(env_prefix=PREFIX, frozen=True, extra="forbid")

    host: str = Field(default="127.0.0.1", description="Address the API listens on.")
    port: int = Field(default=8000, ge=0, le=65535, description="Port the API listens on.")
    data_dir: Path = Field(
        default=Path("maquette-data"),
        description="Folder of the embedded database, the pictures and the results.",
    )
    database_url: str | None = Field(
        default=None,
        description="`postgresql://...` for several machines; SQLite in the data folder if unset.",
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
    worker_processes: int = Field(
        default_factory=lambda: os.cpu_count() or 1,
        ge=1,
        description="Fits one worker runs side by side; the number of CPU cores if unset.",
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
    log_level: str = Field(default="INFO", description="DEBUG, INFO, WARNING or ERROR.")

    @property
    def system_database_url(self) -> str:
        """The database of jobs: the one named, or the embedded one."""
        return self.database_url or f"sqlite:///{self.data_dir.resolve() / 'maquette.sqlite'}"

    @property
    def blob_dir(self) -> Path:
        """The folder of pictures and results."""
        return self.data_dir.resolve() / "blobs"

    def environment(self) -> dict[str, str]:
        """Write these settings as the environment of another process that is to share them."""
        values = self.model_dump(mode="json", exclude_none=True)
        return {f"{PREFIX}{name.upper()}": str(value) for name, value in values.items()}
