"""People, as the labels of fits and scans name them."""

from datetime import datetime

from pydantic import Field

from api_schemas.base import WireModel


class LabelledPerson(WireModel):
    """Everything that has one label."""

    label: str
    fits: int = Field(ge=0, description="How many fits have it.")
    scans: int = Field(ge=0, description="How many scans have it.")
    latest: str = Field(description="Path of the newest of them, whether or not it has ended.")
    latest_at: datetime = Field(description="When that was accepted.")


class PeoplePage(WireModel):
    """People in the order of their labels; ``next`` is the path of the following page."""

    people: tuple[LabelledPerson, ...]
    next: str | None
