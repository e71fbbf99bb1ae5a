"""Whom to notify of a job's end: checked in a request, and read back later."""

import httpx

from api_schemas.problems import FieldProblem
from api_schemas.webhooks import WebhookTarget
from service.blobs import BlobStore
from service.engine.port import JobRecord
from service.settings import Settings
from service.submissions.refusal import refused
from service.webhooks.addresses import is_port_refused, is_refused_outright, port_of


def read_target(blobs: BlobStore, job: JobRecord) -> WebhookTarget | None:
    """Read whom to notify of a job's end; None if nobody.

    Raises
    ------
    BlobMissingError
        If the job was erased meanwhile.
    BlobsUnavailableError
        If the storage does not answer.
    """
    if job.webhook is None:
        return None
    return WebhookTarget.model_validate_json(blobs.get(job.id, job.webhook.target.digest))


def check_webhook(target: WebhookTarget | None, settings: Settings) -> None:
    """Check address and secret; names are looked up only when a notice is sent.

    Raises
    ------
    RefusedError
        If no notice can be sent there, or it could not be signed.
    """
    if target is None:
        return
    try:
        url = httpx.URL(target.url)
    except httpx.InvalidURL as error:
        raise refused(
            FieldProblem(
                field="webhook.url",
                code="unusable-address",
                reason="This is no address of a web server.",
                remedy="Send an address such as https://example.org/hooks/maquette.",
            )
        ) from error
    if is_refused_outright(url.host, settings.allowed_webhook_hosts):
        raise refused(
            FieldProblem(
                field="webhook.url",
                code="address-not-public",
                reason="Notices are sent to public addresses only.",
                remedy="Name a public host; whoever runs the service may allow others by "
                "MAQUETTE_WEBHOOK_HOSTS.",
            )
        )
    if is_port_refused(url, settings.allowed_webhook_hosts, settings.allowed_webhook_ports):
        ports = " or ".join(map(str, settings.allowed_webhook_ports))
        raise refused(
            FieldProblem(
                field="webhook.url",
                code="port-not-allowed",
                reason=f"Notices are not sent to port {port_of(url)}.",
                remedy=f"Receive them at port {ports}; whoever runs the service may allow others "
                "by MAQUETTE_WEBHOOK_PORTS.",
            )
        )
    if target.secret is None and settings.webhook_secret is None:
        raise refused(
            FieldProblem(
                field="webhook.secret",
                code="missing",
                reason="This service has no secret of its own to sign notices with.",
                remedy="Send one; make it with: echo whsec_$(openssl rand -base64 32)",
            )
        )
