"""What the API requires of the people of a tenant, however they are counted."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, slots=True, kw_only=True)
class PersonRecord:
    """A label, how many fits and scans have it, and the newest of them."""

    label: str
    fits: int
    scans: int
    latest_root: str
    latest_id: str
    latest_at: float


class TenantPeople(Protocol):
    """The people whom a tenant has labelled fits or scans with."""

    def people(self, *, limit: int, after: str | None) -> Sequence[PersonRecord]:
        """Return people by label; ``after`` is that of the last one seen.

        Raises
        ------
        EngineUnavailableError
            If the database is unavailable.
        """
        ...
