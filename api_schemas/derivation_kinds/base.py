"""What all kinds of derivations have in common on the wire."""

from pydantic import ConfigDict

from api_schemas.base import WireModel
from api_schemas.results import Artifact
from api_schemas.webhooks import WebhookTarget


class DerivationOptions(WireModel):
    """What all requests for a derivation have in common."""

    webhook: WebhookTarget | None = None


class DerivedFiles(WireModel):
    """What all results of derivations have in common."""

    # What is always answered is said to be: ``kind`` tells one from another.
    model_config = ConfigDict(json_schema_serialization_defaults_required=True)

    artifacts: tuple[Artifact, ...]
