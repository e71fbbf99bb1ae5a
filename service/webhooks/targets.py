"""Whether a notice may be sent where a request wants it, as far as that can be told at once."""

import httpx

from api_schemas.problems import FieldProblem
from api_schemas.webhooks import WebhookTarget
from service.refusal import refused
from service.settings import Settings
from service.webhooks.addresses import is_refused_outright


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
        host = httpx.URL(target.url).host
    except httpx.InvalidURL as error:
        raise refused(
            FieldProblem(
                field="webhook.url",
                code="unusable-address",
                reason="This is no address of a web server.",
                remedy="Send an address such as https://example.org/hooks/maquette.",
            )
        ) from error
    if is_refused_outright(host, settings.allowed_webhook_hosts):
        raise refused(
            FieldProblem(
                field="webhook.url",
                code="address-not-public",
                reason="Notices are sent to public addresses only.",
                remedy="Name a public host; whoever runs the service may allow others by "
                "MAQUETTE_WEBHOOK_HOSTS.",
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
