"""What derivations are made of, and lie below: fits and scans."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final
from uuid import UUID

from fastapi import Path

from api_schemas.base import WireModel
from api_schemas.derivations import Derivation, DerivationPage
from api_schemas.jobs import JobStanding
from api_schemas.scans import ScanDerivation, ScanDerivationPage
from service.api.context import ApiContext
from service.engine.port import FIT, SCAN, JobRecord, TenantJobs
from service.representation.jobs import (
    collection_path,
    represent_derivation,
    represent_scan_derivation,
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Parents:
    """What derivations are made of: fits, or scans.

    ``jobs`` are those of the caller. Names of operations end in ``suffix``. ``represent`` makes an
    answer of the type ``model`` of a record.
    """

    root: str
    suffix: str
    jobs: Callable[[ApiContext], TenantJobs]
    model: type[JobStanding]
    page: Callable[..., WireModel]
    represent: Callable[[JobRecord], JobStanding]

    @property
    def path(self) -> str:
        """Below the service's root, with its parameter."""
        return f"{collection_path(self.root)}/{{{self.root}_id}}/derivations"

    @property
    def parameter(self) -> Any:
        """Its id in the path."""
        return Path(alias=f"{self.root}_id", title=f"{self.root.capitalize()} Id")

    def below(self, context: ApiContext, parent_id: UUID) -> TenantJobs:
        """What is derived from one of them."""
        return self.jobs(context).derivations(str(parent_id))


FITS: Final = Parents(
    root=FIT,
    suffix="",
    jobs=lambda context: context.jobs,
    model=Derivation,
    page=DerivationPage,
    represent=represent_derivation,
)
SCANS: Final = Parents(
    root=SCAN,
    suffix="_of_scan",
    jobs=lambda context: context.scans,
    model=ScanDerivation,
    page=ScanDerivationPage,
    represent=represent_scan_derivation,
)
