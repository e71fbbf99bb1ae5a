"""Signatures of Standard Webhooks 1.0: HMAC-SHA256 of id, timestamp and body."""

import base64
import hashlib
import hmac

from api_schemas.webhooks import secret_key


def signed_headers(*, notice_id: str, timestamp: int, body: bytes, secret: str) -> dict[str, str]:
    """Return the headers that identify, date and sign a notice; ``timestamp`` in epoch seconds."""
    content = f"{notice_id}.{timestamp}.".encode() + body
    signature = base64.b64encode(hmac.digest(secret_key(secret), content, hashlib.sha256)).decode()
    return {
        "webhook-id": notice_id,
        "webhook-timestamp": str(timestamp),
        "webhook-signature": f"v1,{signature}",
    }
