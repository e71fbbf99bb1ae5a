"""What the root of the service answers."""

from api_schemas.base import WireModel


class ServiceIndex(WireModel):
    """The service's name, version and ways in; ``links`` are paths below its root."""

    name: str
    version: str
    links: dict[str, str]
