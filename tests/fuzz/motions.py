"""Motions as BVH files, sound and damaged: in their bytes, numbers, words and counts."""

import random
import re
from collections.abc import Mapping

from tests.fuzz.mutations import damaged

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

BONES: Mapping[str, tuple[str | None, tuple[float, float, float]]] = {
    "Hips": (None, (0.0, 95.0, 0.0)),
    "LowerBack": ("Hips", (0.0, 10.0, 0.0)),
    "Chest": ("LowerBack", (0.0, 15.0, 0.0)),
    "Neck": ("Chest", (0.0, 25.0, 0.0)),
    "Head": ("Neck", (0.0, 8.0, 0.0)),
    **{
        f"{side}{joint}": (f"{side}{parent}" if parent != "Chest" else parent, (sign * x, y, z))
        for side, sign in (("Left", 1.0), ("Right", -1.0))
        for joint, parent, (x, y, z) in (
            ("Shoulder", "Chest", (18.0, 20.0, 0.0)),
            ("Elbow", "Shoulder", (28.0, 0.0, 0.0)),
            ("Wrist", "Elbow", (25.0, 0.0, 0.0)),
        )
    },
    **{
        f"{side}{joint}": (f"{side}{parent}" if parent != "Hips" else parent, (sign * x, y, z))
        for side, sign in (("Left", 1.0), ("Right", -1.0))
        for joint, parent, (x, y, z) in (
            ("Hip", "Hips", (9.0, -5.0, 0.0)),
            ("Knee", "Hip", (0.0, -40.0, 0.0)),
            ("Ankle", "Knee", (0.0, -40.0, 0.0)),
        )
    },
}
"""Parent and offset, centimetres, of a skeleton under CMU's names."""


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
    lines, order = ["HIERARCHY"], list[str]()

    def write(name: str) -> None:
        order.append(name)
        parent, offset = BONES[name]
        lines.append(f"{'JOINT' if parent else 'ROOT'} {name}")
        lines.append("{")
        lines.append("OFFSET " + " ".join(map(str, offset)))
        places = "" if parent else "Xposition Yposition Zposition "
        channels = f"{places}Zrotation Xrotation Yrotation"
        lines.append(f"CHANNELS {len(channels.split())} {channels}")
        children = [each for each, (above, _) in BONES.items() if above == name]
        for child in children:
            write(child)
        if not children:
            lines.extend(["End Site", "{", "OFFSET 0 -5 8", "}"])
        lines.append("}")

    write("Hips")
    frames = chance.randint(1, MOST_FRAMES)
    lines += ["MOTION", f"Frames: {frames}", "Frame Time: 0.0333333"]
    for frame in range(frames):
        turns = [chance.uniform(-20.0, 20.0) for _ in range(3 * len(order))]
        lines.append(" ".join(f"{number:.3f}" for number in (frame, 95.0, 0.0, *turns)))
    return "\n".join(lines).encode()


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
            joint = chance.choice(sorted(BONES)).encode()
            lines = [line.replace(joint, chance.choice((b"", b"Tail", b"Hips"))) for line in lines]
        case _:
            deep = [b"JOINT a", b"{", b"OFFSET 0 0 0", b"CHANNELS 0"] * chance.choice(
                (3, 600, 20_000)
            )
            lines[at:at] = deep
    return b"\n".join(lines)
