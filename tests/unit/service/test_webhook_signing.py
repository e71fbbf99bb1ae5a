import base64
import hashlib
import hmac

import pytest
from pydantic import ValidationError

from api_schemas.jobs import WebhookTarget
from service.webhooks.notices import signed_headers

SECRET = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"


def test_the_signature_is_the_one_of_the_standards_example():
    """Message, secret and signature are those of the specification's reference libraries."""
    headers = signed_headers(
        notice_id="msg_p5jXN8AQM9LWM0D4loKWxJek",
        timestamp=1614265330,
        body=b'{"test": 2432232314}',
        secret=SECRET,
    )
    assert headers == {
        "webhook-id": "msg_p5jXN8AQM9LWM0D4loKWxJek",
        "webhook-timestamp": "1614265330",
        "webhook-signature": "v1,g0hM9SsE+OTPJTGt/tmIKtSyZlE3uFJELVlNIOLJ1OE=",
    }


@pytest.mark.parametrize("change", ["id", "timestamp", "body", "secret"])
def test_the_signature_covers_everything(change):
    values = {"notice_id": "a", "timestamp": 1, "body": b"{}", "secret": SECRET}
    changed = {
        "id": {"notice_id": "b"},
        "timestamp": {"timestamp": 2},
        "body": {"body": b"[]"},
        "secret": {"secret": "whsec_" + base64.b64encode(bytes(24)).decode()},
    }[change]
    one, other = signed_headers(**values), signed_headers(**(values | changed))
    assert one["webhook-signature"] != other["webhook-signature"]


def test_the_key_is_what_the_secret_encodes():
    key = bytes(range(32))
    secret = "whsec_" + base64.b64encode(key).decode()
    headers = signed_headers(notice_id="n", timestamp=7, body=b"x", secret=secret)
    expected = base64.b64encode(hmac.new(key, b"n.7.x", hashlib.sha256).digest()).decode()
    assert headers["webhook-signature"] == f"v1,{expected}"


@pytest.mark.parametrize(
    "secret",
    [
        base64.b64encode(bytes(32)).decode(),
        "whsec_" + base64.b64encode(bytes(23)).decode(),
        "whsec_" + base64.b64encode(bytes(65)).decode(),
        "whsec_not base64!",
    ],
)
def test_a_weak_or_malformed_secret_is_refused(secret):
    with pytest.raises(ValidationError):
        WebhookTarget(url="https://example.org/", secret=secret)


@pytest.mark.parametrize("length", range(24, 65))
def test_every_length_the_standard_allows_is_accepted(length):
    secret = "whsec_" + base64.b64encode(bytes(length)).decode()
    assert WebhookTarget(url="https://example.org/", secret=secret).secret == secret
