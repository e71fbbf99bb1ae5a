"""Requests for products of a fit, damaged in their JSON, their files, their ids, their motions."""

import json
import random
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from api_schemas.products.base import ProductKind
from tests.fuzz.mutations import NASTY, damaged, damaged_document
from tests.fuzz.sending import JSON, MULTIPART, RawRequest, head_and_body, multipart

MOST_FRAMES = 4
"""Few, so that an animation of them takes the worker a second or two."""

NUMBERS = (
    *("nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "0", "-0", "1e9", "-1", "00", "1e"),
    *("99999999999999999999", "-2147483648", "0x10", "1_0", "١٢", "1,5", ""),
)
STRANGE = (
    *("0", "-0", "1e-300", "1e-9", "0.01", "1e3", "1e6", "9e8", "-9e8", "360000", "7.3e5", "-180"),
)
"""Numbers a file may hold, though nobody's body or motion is like that."""

WORDS = ("}", "{", "JOINT", "ROOT", "End Site", "OFFSET", "CHANNELS", "MOTION", "Frames:", "\x00")

CLIP = Path(__file__).parents[1] / "unit" / "applications" / "data" / "bvh" / "r_identity.bvh"
"""A walk under CMU's names."""


def motion(chance: random.Random) -> bytes:
    """A sound file, one in ten; else one damaged in one way or two."""
    content = sound_motion(chance)
    if chance.random() < 0.1:
        return content
    if chance.random() < 0.4:
        return _strange_body(content, chance)
    for _ in range(chance.randint(1, 2)):
        content = chance.choice((damaged, _other_number, _other_words))(content, chance)
    return content


def sound_motion(chance: random.Random) -> bytes:
    """A file with nothing wrong, of a few frames."""
    frames = chance.randint(1, MOST_FRAMES)
    skeleton, _, numbers = CLIP.read_bytes().partition(b"Frames: 40\n")
    lines = numbers.splitlines()[: 1 + frames]
    return b"\n".join([skeleton + b"Frames: %d" % frames, *lines])


def _strange_body(content: bytes, chance: random.Random) -> bytes:
    """Other offsets, angles, places or times, many or few of them: a file that can be read."""
    what, share = chance.choice((rb"(?<=OFFSET ).*", rb"(?<=Frame Time: ).*", rb"\n[-\d. ]+$")), 0.5
    if chance.random() < 0.5:
        share = chance.choice((0.02, 0.1, 1.0))

    def strange(line: re.Match[bytes]) -> bytes:
        one = chance.choice(STRANGE).encode()
        numbers = [
            chance.choice((one, chance.choice(STRANGE).encode()))
            if chance.random() < share
            else number
            for number in line[0].split()
        ]
        return (b"\n" if line[0].startswith(b"\n") else b"") + b" ".join(numbers)

    return re.sub(what, strange, content)


def _other_number(content: bytes, chance: random.Random) -> bytes:
    """Another number in place of one: a count, a length, an angle or a time."""
    found = list(re.finditer(rb"-?\d+(\.\d+)?", content))
    if not found:
        return content
    # Counts and the time are few among the angles: half of the changes are theirs.
    counts = list(re.finditer(rb"(?<=CHANNELS )\d|(?<=Frames: )\d+|(?<=Frame Time: )\S+", content))
    which = chance.choice(counts if counts and chance.random() < 0.5 else found)
    return content[: which.start()] + chance.choice(NUMBERS).encode() + content[which.end() :]


def _other_words(content: bytes, chance: random.Random) -> bytes:
    """Lines left out, doubled, moved or said otherwise; a skeleton within itself."""
    lines = content.split(b"\n")
    at = chance.randrange(len(lines))
    match chance.randrange(6):
        case 0:
            del lines[at]
        case 1:
            lines[at:at] = lines[at : at + chance.randint(1, 40)]
        case 2:
            lines.insert(chance.randrange(len(lines)), lines.pop(at))
        case 3:
            lines[at] = chance.choice(WORDS).encode()
        case 4:
            joint = chance.choice(re.findall(rb"JOINT (\w+)", content) or [b"Hips"])
            lines = [line.replace(joint, chance.choice((b"", b"Tail", b"Hips"))) for line in lines]
        case _:
            deep = [b"JOINT a", b"{", b"OFFSET 0 0 0", b"CHANNELS 0"] * chance.choice(
                (3, 600, 20_000)
            )
            lines[at:at] = deep
    return b"\n".join(lines)


FIT_ID = "11111111-1111-4111-8111-111111111111"
PRODUCT_ID = "2" * 32
OTHER_FIT_ID = "33333333-3333-4333-8333-333333333333"
"""Stand for those of fits and of a product that there are: put in place of them on sending."""

UNKNOWN_ID = "00000000-0000-4000-8000-000000000000"
IDS = (FIT_ID, OTHER_FIT_ID, PRODUCT_ID, UNKNOWN_ID, "", "0", "%00", "..")

KINDS = tuple(each.value for each in ProductKind)
FACTORS = (0, 1, 0.5, 2.5, 3, 6, 99.9, 100, 100.1, -1, 1e-300)
PARTS = ("head", "left_forearm", "right_thigh", "pelvis", "left_foot", "chest", "tail")
POSES = ("rest", "standing", "a_pose", "t_pose", "relaxed", "walking", "sitting", "arms_raised")


def product_body(chance: random.Random) -> RawRequest:
    """A request as JSON: sound of its kind, or damaged in its values, its nesting or its text."""
    document = _document(chance)
    text = json.dumps(document).encode()
    roll = chance.random()
    if roll < 0.45:
        text = json.dumps(damaged_document(document, chance)).encode()
    elif roll < 0.6:
        text = damaged(text, chance)
    return head_and_body(_path(chance), JSON, text)


def product_form(chance: random.Random) -> RawRequest:
    """A form with a file, mostly damaged, and now and then of the wrong kind."""
    document: dict[str, Any] = {"kind": "animation"}
    document["start_s"] = chance.choice((0, 0, 0.05, 3600, -1))
    if chance.random() < 0.3:
        document["up"] = chance.choice(("y", "z", "-x", "w"))
    if chance.random() < 0.3:
        part, name = (chance.choice(("pelvis", "chest", "left_shin", "tail")) for _ in range(2))
        document["joints"] = {part: chance.choice(("Hips", "LeftKnee", "Chest", name))}
    parts = {"bvh": motion(chance)}
    if chance.random() < 0.15:
        document = _document(chance)
    if chance.random() < 0.1:
        parts[chance.choice(("bvh", "chart", "image", "mask", ""))] = b"HIERARCHY\n"
    parts["request"] = json.dumps(document).encode()
    if chance.random() < 0.1:
        parts["request"] = damaged(parts["request"], chance)
    body = multipart(parts)
    if chance.random() < 0.1:
        body = damaged(body, chance)
    return head_and_body(_path(chance), MULTIPART, body)


def with_ids(request: RawRequest, ids: Mapping[str, str]) -> RawRequest:
    """The request about fits and a product that there are; ids are all of one length."""
    content = request.content
    for stands_for, found in ids.items():
        content = content.replace(stands_for.encode(), found.encode())
    return RawRequest(content=content, is_well_framed=request.is_well_framed)


def _path(chance: random.Random) -> str:
    fit = FIT_ID if chance.random() < 0.9 else chance.choice(IDS)
    return f"/v1/fits/{fit}/products"


def _document(chance: random.Random) -> dict[str, Any]:
    """A request of a kind, mostly of its schema; half of all are quickly made."""
    kind = chance.choice((*KINDS, "caricature", "pose", "pose", "bust"))
    match kind:
        case "caricature":
            return {"kind": kind, "factor": chance.choice(FACTORS)}
        case "pose":
            parts = chance.sample(PARTS, chance.randint(0, 3))
            return {
                "kind": kind,
                "pose": chance.choice(POSES),
                "rotations": {part: _rotation(chance) for part in parts},
            }
        case "animation":
            # Of the walk that ships with the package no more than a moment.
            return {"kind": kind, "start_s": chance.choice((0, 0.5)), "duration_s": 0.05}
        case "texture":
            colours = chance.choice(("picture", "albedo", "plain"))
            return {"kind": kind, "colours": colours, "size": chance.choice((512, 512, 700))}
        case "composition":
            return {"kind": kind, "age_years": chance.choice((None, 0, 17.5, 40, 120, 121))}
        case "size":
            charts = ("size,chest_girth\nM,94-98\n", "size,chest_girth\nM,98-94\n", "size")
            return {"kind": kind, "chart_csv": chance.choice(charts), "ease": {"chest_girth": 4}}
        case _:
            return {"kind": kind}


def _rotation(chance: random.Random) -> Any:
    if chance.random() < 0.2:
        return chance.choice(NASTY)
    largest = chance.choice((0.2, 0.2, 0.2, 3.2, 6.2832, 7.0))
    return [chance.uniform(-largest, largest) for _ in range(chance.choice((3, 3, 4, 2, 5)))]
