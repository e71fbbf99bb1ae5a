"""Requests for scans and for what is made of them, damaged in their pictures, views and ids."""

import json
import random
from functools import cache
from typing import Any

from tests.fuzz.derivations import (
    DERIVATION_ID,
    FIT_ID,
    IDS,
    UNKNOWN_ID,
    derivation_address,
    derivation_body,
    derivation_form,
)
from tests.fuzz.messages import JSON, MULTIPART, RawRequest, head_and_body, multipart
from tests.fuzz.mutations import damaged, damaged_document
from tests.fuzz.pictures import black_mask, picture, sound_picture
from tests.submissions import Submission, small_submissions

SCAN_ID = "44444444-4444-4444-8444-444444444444"
SCAN_DERIVATION_ID = "55555555-5555-4555-8555-555555555555"
"""Stand for those of a scan and of a derivation of it that there are, as those of fits do."""

KINDS_OF_VIEW = ("front", "side", "back", "other", "other", "above", "")
SUBPATHS = (
    *("", "/", "/events", "/request", "/result", "/derivations", "/cancel"),
    *("/views/0/image", "/views/1/mask", "/views/-1/image", "/views/6/image", "/views/x/image"),
    *("/artifacts/overlay_1.png", "/artifacts/overlay_9.png", "/artifacts/body_posed_0.obj"),
)


def sound_scan() -> tuple[dict[str, bytes], dict[str, Any]]:
    """Pictures by part, and the request, of a scan that succeeds: one small picture seen twice."""
    real = _real()
    asked = json.loads(real.request)
    seen = {name: asked.pop(name) for name in ("points", "focal_length_px") if name in asked}
    views = [{"view": kind, **seen} for kind in ("front", "other")]
    return {"image_0": real.image, "image_1": real.image}, asked | {"views": views}


def scanned_pictures(chance: random.Random) -> RawRequest:
    """Pictures of which one, or its mask, is damaged, after sound ones or before them."""
    parts, asked = sound_scan()
    spoilt = chance.randrange(2)
    if chance.random() < 0.3:
        parts[f"mask_{spoilt}"] = picture(chance)
        parts[f"image_{spoilt}"] = sound_picture()
    else:
        parts[f"image_{spoilt}"] = picture(chance)
        # What is sound after all ends at the mask of nobody.
        parts[f"mask_{spoilt}"] = black_mask()
    asked["views"][spoilt]["points"] = _inside()
    parts["request"] = json.dumps(asked).encode()
    return head_and_body("/v1/scans", MULTIPART, multipart(parts))


def scan_form(chance: random.Random) -> RawRequest:
    """Too many views, too few or damaged ones, parts that belong to none, broken forms."""
    _, asked = sound_scan()
    count = chance.choice((0, 1, 2, 2, 2, 3, 6, 7, 40))
    kinds = chance.choices(KINDS_OF_VIEW, k=count)
    asked["views"] = [{"view": kind, "points": _inside()} for kind in kinds]
    if chance.random() < 0.4:
        asked = damaged_document(asked, chance)
    numbers = chance.choice((range(count), range(1, count), range(count + 1), (0, 0, 7, -1, "x")))
    parts = {f"image_{number}": sound_picture()[:200] for number in numbers}
    if chance.random() < 0.2:
        parts[chance.choice(("mask_0", "mask_9", "image", "mask", "image_00", ""))] = black_mask()
    parts["request"] = json.dumps(asked).encode()
    body = multipart(parts)
    return head_and_body(
        "/v1/scans", MULTIPART, damaged(body, chance) if chance.random() < 0.3 else body
    )


def scan_body(chance: random.Random) -> RawRequest:
    """JSON whose pictures were uploaded before, or not."""
    _, asked = sound_scan()
    for view in asked["views"]:
        view["image_id"] = chance.choice(("0" * 64, "", "0" * 63, UNKNOWN_ID))
    text = json.dumps(damaged_document(asked, chance) if chance.random() < 0.6 else asked).encode()
    return head_and_body(
        "/v1/scans", JSON, damaged(text, chance) if chance.random() < 0.3 else text
    )


def scan_address(chance: random.Random) -> RawRequest:
    """Any of the paths below a scan; the one that there is stays."""
    scan = SCAN_ID if chance.random() < 0.6 else chance.choice(IDS)
    method = chance.choice(("GET", "GET", "GET", "PUT", "POST", "DELETE"))
    below = chance.choice(SUBPATHS)
    if method == "DELETE" and scan == SCAN_ID:
        scan = UNKNOWN_ID
    head = f"{method} /v1/scans/{scan}{below} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 0\r\n"
    return RawRequest(content=f"{head}Connection: close\r\n\r\n".encode())


def scan_derivation(chance: random.Random) -> RawRequest:
    """What is asked of fits, asked of a scan."""
    made = chance.choice((derivation_body, derivation_form, derivation_address))(chance)
    content = made.content
    for of_fits, of_scans in (
        (f"/v1/fits/{FIT_ID}", f"/v1/scans/{SCAN_ID}"),
        (f"/derivations/{DERIVATION_ID}", f"/derivations/{SCAN_DERIVATION_ID}"),
        ("/v1/fits/", "/v1/scans/"),
    ):
        content = content.replace(of_fits.encode(), of_scans.encode(), 1)
    return RawRequest(content=content, is_well_framed=made.is_well_framed)


@cache
def _real() -> Submission:
    (found,) = small_submissions(1)
    return found


def _inside() -> dict[str, list[float]]:
    """Points of which all lie in the fuzzer's own pictures too."""
    return {
        "left_shoulder": [46.0, 24.0],
        "right_shoulder": [26.0, 24.0],
        "left_elbow": [50.0, 38.0],
        "right_elbow": [22.0, 38.0],
        "left_hip": [42.0, 50.0],
        "right_hip": [30.0, 50.0],
        "left_knee": [43.0, 70.0],
        "right_knee": [29.0, 70.0],
    }
