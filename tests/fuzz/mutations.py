"""Damage done to bytes, and to values of a JSON document."""

import copy
import random
from typing import Any

LARGEST_SLICE = 64
EDGES = (
    b"\x00",
    b"\xff",
    b"\x00\x00\x00\x00",
    b"\xff\xff\xff\xff",
    b"\x7f\xff\xff\xff",
    b"\x80\x00",
)
"""What counts and lengths are wrong at."""

NAMES = ("", "\x00", "\ud800", "__proto__")

NASTY: tuple[Any, ...] = (
    None,
    True,
    0,
    -1,
    1e-320,
    1e308,
    float("nan"),
    float("inf"),
    10**400,
    2**63,
    "",
    "\x00",
    "\ud800",
    "\u202eevil\u0000",
    "x" * 10_000,
    "../../etc/passwd",
    "'; DROP TABLE maquette_jobs; --",
    [],
    {},
    [[[[[[]]]]]],
    [float("nan"), 1],
    {"": {"": ""}},
    {"\ud800": 1},
    {"x": float("inf"), "y": -1},
    {"value": 1e308, "standard_error": -1},
)


def damaged(content: bytes, chance: random.Random) -> bytes:
    """Change a few places of some bytes."""
    damaged_bytes = bytearray(content)
    for _ in range(chance.randint(1, 6)):
        at = chance.randrange(len(damaged_bytes) + 1)
        length = chance.randint(1, LARGEST_SLICE)
        match chance.randrange(7):
            case 0 if at < len(damaged_bytes):
                damaged_bytes[at] ^= 1 << chance.randrange(8)
            case 1:
                damaged_bytes[at : at + length] = b""
            case 2:
                damaged_bytes[at:at] = chance.randbytes(length)
            case 3:
                source = chance.randrange(len(damaged_bytes) + 1)
                damaged_bytes[at : at + length] = damaged_bytes[source : source + length]
            case 4:
                edge = chance.choice(EDGES)
                damaged_bytes[at : at + len(edge)] = edge
            case 5 if chance.random() < 0.3:
                del damaged_bytes[at:]
            case _:
                damaged_bytes[at : at + 1] = chance.randbytes(1)
    return bytes(damaged_bytes)


def damaged_document(document: Any, chance: random.Random) -> Any:
    """Change a few values, names or nestings of a JSON document."""
    changed = copy.deepcopy(document)
    for _ in range(chance.randint(1, 3)):
        holder = chance.choice(_containers(changed))
        keys = list(holder) if isinstance(holder, dict) else list(range(len(holder)))
        if not keys:
            continue
        key = chance.choice(keys)
        match chance.randrange(5):
            case 0:
                del holder[key]
            case 1 if isinstance(holder, dict):
                holder[chance.choice((*NAMES, str(key).upper()))] = holder[key]
            case 2 if isinstance(holder, list):
                holder.extend([holder[key]] * chance.choice((1, 5_000)))
            case 3:
                holder[key] = copy.deepcopy(document)
            case _:
                holder[key] = copy.deepcopy(chance.choice(NASTY))
    return changed


def _containers(value: Any) -> list[Any]:
    if not isinstance(value, (dict, list)):
        return []
    inner = value.values() if isinstance(value, dict) else value
    return [value, *(found for each in inner for found in _containers(each))]
