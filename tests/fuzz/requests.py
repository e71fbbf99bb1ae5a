"""Raw HTTP requests, damaged in one way each."""

import json
import random
from collections.abc import Callable, Mapping
from typing import Any

from tests.fuzz.mutations import damaged, damaged_document
from tests.fuzz.pictures import black_mask, picture, sound_picture
from tests.fuzz.products import (
    UNKNOWN_ID,
    product_body,
    product_form,
)
from tests.fuzz.sending import JSON, MULTIPART, RawRequest, head_and_body, multipart

DEEP = 5_000

POINTS = {
    "nose": [36, 12],
    "left_shoulder": [46, 24],
    "right_shoulder": [26, 24],
    "left_elbow": [50, 38],
    "right_elbow": [22, 38],
    "left_hip": {"x": 42, "y": 50, "visibility": 2},
    "right_hip": [30, 50],
    "left_knee": [43, 70],
    "right_knee": [29, 70],
}
PERSON = {
    "gender": "female",
    "height_m": 1.7,
    "weight_kg": 61.0,
    "measurements": {"waist_girth_navel": {"value": 80, "standard_error": 1}},
}
SEEN = {
    "points": POINTS,
    "focal_length_px": 90.0,
    "limb_facing": {"left_shin": "toward"},
}
VIEW = SEEN | {"light": {"kind": "point"}, "clothing": {"upper": "loose"}}
FIT = PERSON | {"cues": "SE", "optimizer": "gauss_newton", "views": [VIEW]}
DOCUMENTS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("/v1/bodies", {"gender": "male", "height_m": 1.8, "measurements": {"inseam": 80}}),
    ("/v1/initial-poses", PERSON | SEEN | {"image_size": {"width": 72, "height": 96}}),
    (
        "/v1/points",
        {
            "image_id": "0" * 64,
            "view": "side",
            "person": 0,
            "mask": True,
            "points": POINTS,
            "height_m": 1.7,
            "focal_length_px": 90.0,
        },
    ),
    ("/v1/fits", FIT | {"views": [VIEW | {"image_id": "0" * 64, "mask_id": "1" * 64}]}),
    (
        "/v1/fits",
        FIT
        | {"views": [VIEW | {"view": each, "image_id": "0" * 64} for each in ("front", "side")]},
    ),
)
HEADERS = (
    "Accept",
    "Content-Length",
    "Content-Type",
    "Expect",
    "Host",
    "Idempotency-Key",
    "If-None-Match",
    "Last-Event-ID",
    "Origin",
    "Prefer",
    "Transfer-Encoding",
    "X-Request-Id",
)
HEADER_VALUES = (
    b"",
    b"*",
    b"\xff\xfe",
    b"a" * 3_000,
    b"-1",
    b"99999999999999999999999",
    b"wait=1000000, wait=-1",
    b"bytes=0-0,2-,-1,9-1",
    b"bytes=-99999999999999999999",
    b"chunked",
    b"100-continue",
    b"multipart/form-data",
    b"multipart/form-data; boundary=" + b"x" * 300,
    b"application/json; charset=utf-7",
    b"null",
    b"http://[::1",
    b"00-" + b"0" * 32 + b"-" + b"0" * 16 + b"-01",
    'W/"é"'.encode(),
)
PATHS = (
    "/",
    "/docs",
    "/healthz/ready",
    "/metrics",
    "/openapi.json",
    "/problems/unheard-of",
    "/v1/body-models",
    "/v1/fits",
    f"/v1/fits/{UNKNOWN_ID}",
    f"/v1/fits/{UNKNOWN_ID}/events",
    f"/v1/fits/{UNKNOWN_ID}/result",
    f"/v1/fits/{UNKNOWN_ID}/files/views/0/overlay.png",
    f"/v1/images/{'0' * 64}",
)
METHODS = ("GET", "GET", "GET", "HEAD", "POST", "PUT", "DELETE", "OPTIONS", "PATCH", "BREW")


def uploaded_picture(chance: random.Random) -> RawRequest:
    """A damaged picture to keep: the API looks at its header."""
    return head_and_body("/v1/images", MULTIPART, multipart({"image": picture(chance)}))


def fitted_picture(chance: random.Random) -> RawRequest:
    """A damaged picture or mask to fit: decoded in a process of its own."""
    spoilt_mask = chance.random() < 0.3
    parts = {
        "image": sound_picture() if spoilt_mask else picture(chance),
        "mask": picture(chance) if spoilt_mask else black_mask(),
        "request": json.dumps(FIT | {"weight_kg": None, "measurements": {}}).encode(),
    }
    return head_and_body("/v1/fits", MULTIPART, multipart(parts))


def proposed_picture(chance: random.Random) -> RawRequest:
    """A damaged picture to propose points of: decoded by an estimator, which lives on."""
    request = json.dumps({"mask": chance.random() < 0.5}).encode()
    return head_and_body(
        "/v1/points", MULTIPART, multipart({"image": picture(chance), "request": request})
    )


def json_body(chance: random.Random) -> RawRequest:
    """A damaged JSON document: its values, its nesting or its text."""
    path, document = chance.choice(DOCUMENTS)
    if chance.random() < 0.05:
        text = b"[" * DEEP + b"]" * DEEP
    elif chance.random() < 0.7:
        text = json.dumps(damaged_document(document, chance)).encode()
    else:
        text = damaged(json.dumps(document).encode(), chance)
    return head_and_body(path, JSON, text)


def multipart_body(chance: random.Random) -> RawRequest:
    """A damaged multipart body, or a sound one of damaged options."""
    parts = {"image": sound_picture()[:200], "request": json.dumps(FIT).encode()}
    if chance.random() < 0.4:
        parts["request"] = json.dumps(damaged_document(FIT, chance)).encode()
        return head_and_body("/v1/fits", MULTIPART, multipart(parts))
    return head_and_body(
        chance.choice(("/v1/fits", "/v1/images")), MULTIPART, damaged(multipart(parts), chance)
    )


def headers(chance: random.Random) -> RawRequest:
    """A sound request with a few headers nobody sends."""
    path = chance.choice(PATHS)
    lines = [f"{chance.choice(METHODS)} {path} HTTP/1.1".encode(), b"Host: 127.0.0.1"]
    for _ in range(chance.randint(1, 4)):
        value = chance.choice(HEADER_VALUES)
        if chance.random() < 0.3:
            value = damaged(value, chance)
        lines.append(chance.choice(HEADERS).encode() + b": " + value)
    content = b"\r\n".join([*lines, b"Connection: close", b"", b""])
    if chance.random() < 0.2:
        content = damaged(content, chance)
    return RawRequest(content=content, is_well_framed=False)


KINDS: Mapping[str, tuple[Callable[[random.Random], RawRequest], float]] = {
    "picture, uploaded": (uploaded_picture, 0.15),
    "picture, fitted": (fitted_picture, 0.1),
    "picture, proposed": (proposed_picture, 0.06),
    "JSON body": (json_body, 0.2),
    "multipart body": (multipart_body, 0.13),
    "headers": (headers, 0.1),
    "product, JSON": (product_body, 0.05),
    "product, form": (product_form, 0.07),
}
"""Makers of requests, and how often each is taken, in proportion."""
