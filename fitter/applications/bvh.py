"""BVH files as text: a skeleton at rest, and the numbers of its joints frame by frame.

A file has a HIERARCHY of joints (OFFSET from the parent, CHANNELS in the order in which numbers
come) and a MOTION of frames. Every error names the line. What a file says against itself, or says
in an unusual way that has one meaning only, is read with a warning.

Plain Python and no arrays: the process that accepts requests reads a file with this module before
the job is queued, and the job reads it again. Of the ten irregular files that its tests read,
bvh 0.3 reads three, pybvh 0.9 two and bvhio 1.5.4 one; `Frames:40` and wrapped rows none of them.
"""

import codecs
import math
from array import array
from collections.abc import Iterator
from dataclasses import dataclass

from fitter.errors import InvalidInputError
from fitter.vocabulary.remarks import Note, Remark, remark

FIELD = "bvh"
"""The request field that errors name."""

MAX_BYTES = 32 * 2**20
MAX_FRAMES = 20_000
"""Nearly three minutes at 120 Hz."""

MAX_JOINTS = 512
FRAME_TIMES_S = (1e-5, 10.0)
"""No recording has more frames a second, or fewer."""

LARGEST_NUMBER = 1e9
"""Beyond it no length and no angle is meant; far below where squares overflow."""

CHANNELS = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in "XYZ")

_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)

Offset = tuple[float, float, float]


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BvhFile:
    """Contents of a file, in its own axes and unit of length.

    Attributes
    ----------
    names
        Of the j joints, parents before children; ends of chains have no name and are not among
        them.
    parents
        Of each joint; -1 for the root.
    offsets
        Of each joint from its parent, at rest.
    ends, end_parents
        Offsets of the chains' ends, and the joints they belong to.
    channels
        Of each joint, in the order of the numbers.
    frame_time_s
        Seconds from frame to frame.
    frames
        How many there are.
    numbers
        All frames, one after the other: lengths, and degrees.
    warnings
        What the file says in an unusual way or against itself.
    """

    names: tuple[str, ...]
    parents: tuple[int, ...]
    offsets: tuple[Offset, ...]
    ends: tuple[Offset, ...]
    end_parents: tuple[int, ...]
    channels: tuple[tuple[str, ...], ...]
    frame_time_s: float
    frames: int
    numbers: "array[float]"
    warnings: tuple[Remark, ...]


def read_bvh(content: bytes) -> BvhFile:
    """Read a BVH file.

    Parameters
    ----------
    content
        Of the file: UTF-8, UTF-16 with a byte order mark, or any encoding that agrees with ASCII.

    Raises
    ------
    InvalidInputError
        If it is too large, no BVH, or says something impossible; with the line.
    """
    if len(content) > MAX_BYTES:
        raise _error(
            code="bvh-too-large",
            reason=f"The file has {len(content)} bytes, more than {MAX_BYTES}.",
        )
    encoding = "utf-16" if content.startswith(_UTF_16) else "utf-8-sig"
    lines = _Lines(content.decode(encoding, errors="replace"))
    nodes = list(_hierarchy(lines))
    joints = [node for node in nodes if node.name is not None]
    ends = [node for node in nodes if node.name is None]
    frame_time_s, frames, numbers = _motion(lines, sum(len(joint.channels) for joint in joints))
    return BvhFile(
        names=tuple(str(joint.name) for joint in joints),
        parents=tuple(joint.parent for joint in joints),
        offsets=tuple(joint.offset for joint in joints),
        ends=tuple(end.offset for end in ends),
        end_parents=tuple(end.parent for end in ends),
        channels=tuple(joint.channels for joint in joints),
        frame_time_s=frame_time_s,
        frames=frames,
        numbers=numbers,
        warnings=tuple(remark(Note.BVH_IRREGULAR, message) for message in lines.irregular),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Node:
    """A joint, or the end of a chain, which has no name."""

    name: str | None
    parent: int
    offset: Offset
    channels: tuple[str, ...]


class _Lines:
    """The lines that are not blank, one after the other; a brace is a line of its own."""

    def __init__(self, text: str) -> None:
        self._lines = enumerate(text.splitlines(), start=1)
        self._rest_of_line: list[list[str]] = []
        self.number = 0
        self.irregular: list[str] = []

    def words(self) -> list[str]:
        """The words of the next line that has any; none at the file's end."""
        while not self._rest_of_line:
            self.number, line = next(self._lines, (self.number, None))
            if line is None:
                return []
            parts = line.replace("{", "\n{\n").replace("}", "\n}\n").split("\n")
            self._rest_of_line = [words for words in map(str.split, parts) if words]
        return self._rest_of_line.pop(0)

    def rows(self) -> Iterator[tuple[int, list[str]]]:
        """The words of each line not read yet that has any, with its number."""
        for number, line in self._lines:
            words = line.split()
            if words:
                yield number, words

    def expected(self, words: list[str], *, what: str) -> InvalidInputError:
        found = f"found {' '.join(words)[:60]!r}" if words else "the file ends"
        return _error(
            code="bvh-unreadable", reason=f"Line {self.number}: {found}, expected {what}."
        )


def _hierarchy(lines: _Lines) -> Iterator[_Node]:
    words = lines.words()
    if [word.upper() for word in words] != ["HIERARCHY"]:
        raise _error(
            code="not-a-bvh", reason="The motion does not begin with HIERARCHY: it is no BVH file."
        )
    words = lines.words()
    if len(words) < 2 or words[0].upper() != "ROOT":
        raise lines.expected(words, what="ROOT and a name")
    # Joints that are open, innermost last; -1 stands for an end site.
    open_joints: list[int] = []
    names: set[str] = set()
    while True:
        kind = words[0].upper() if words else ""
        if kind == "}" and open_joints:
            open_joints.pop()
            if not open_joints:
                return
        elif kind in ("ROOT", "JOINT") and len(words) >= 2 and open_joints[-1:] != [-1]:
            joint = _joint(lines, " ".join(words[1:]), open_joints[-1] if open_joints else -1)
            if joint.name in names:
                raise _error(
                    code="bvh-unreadable",
                    reason=f"Line {lines.number}: a second joint has the name {joint.name!r}.",
                )
            if len(names) == MAX_JOINTS:
                raise _error(
                    code="bvh-too-large",
                    reason=f"Line {lines.number}: the skeleton has more than {MAX_JOINTS} joints.",
                )
            open_joints.append(len(names))
            names.add(str(joint.name))
            yield joint
        elif kind == "END" and open_joints and open_joints[-1] >= 0:
            yield _Node(name=None, parent=open_joints[-1], offset=_offset(lines), channels=())
            open_joints.append(-1)
        else:
            raise lines.expected(words, what="JOINT and a name, End Site or }")
        words = lines.words()


def _joint(lines: _Lines, name: str, parent: int) -> _Node:
    offset = _offset(lines)
    words = lines.words()
    if len(words) < 2 or words[0].upper() != "CHANNELS" or not words[1].isdecimal():
        raise lines.expected(words, what="CHANNELS, how many and which")
    channels = tuple(word[:1].upper() + word[1:].lower() for word in words[2:])
    if len(channels) != int(words[1]) or len(set(channels)) != len(channels):
        raise lines.expected(words, what=f"{words[1]} different channels")
    for channel in channels:
        if channel not in CHANNELS:
            raise lines.expected(words, what=f"channels of {', '.join(CHANNELS)}")
    return _Node(name=name, parent=parent, offset=offset, channels=channels)


def _offset(lines: _Lines) -> Offset:
    words = lines.words()
    if words != ["{"]:
        raise lines.expected(words, what="{")
    words = lines.words()
    if len(words) != 4 or words[0].upper() != "OFFSET":
        raise lines.expected(words, what="OFFSET and three numbers")
    try:
        x, y, z = (float(word) for word in words[1:])
    except ValueError:
        raise lines.expected(words, what="OFFSET and three numbers") from None
    if not _can_be_meant([x, y, z]):
        raise lines.expected(words, what="finite numbers, of 1e9 at most")
    return x, y, z


def _motion(lines: _Lines, channels: int) -> "tuple[float, int, array[float]]":
    words = lines.words()
    if [word.upper() for word in words] != ["MOTION"]:
        raise lines.expected(words, what="MOTION")
    words = _after(lines, "Frames:")
    if len(words) != 1 or not words[0].isdecimal():
        raise lines.expected(words, what="Frames: and a whole number")
    announced = int(words[0])
    if not 1 <= announced <= MAX_FRAMES:
        raise _error(
            code="bvh-too-long" if announced else "bvh-unreadable",
            reason=f"Line {lines.number}: the clip has {announced} frames, not 1 to {MAX_FRAMES}.",
        )
    words = _after(lines, "Frame Time:")
    try:
        frame_time_s = float(" ".join(words))
    except ValueError:
        raise lines.expected(words, what="Frame Time: and seconds") from None
    least, most = FRAME_TIMES_S
    if not least <= frame_time_s <= most:
        raise lines.expected(words, what=f"seconds from {least:g} to {most:g}")
    frames, numbers = _frames(lines, channels, announced)
    if frames < announced - 1:
        raise _error(
            code="bvh-unreadable",
            reason=f"The file ends after {frames} of the {announced} frames that were announced.",
        )
    if frames != announced:
        lines.irregular.append(
            f"The file announces {announced} frames and has {frames}: those it has are taken."
        )
    return frame_time_s, frames, numbers


def _after(lines: _Lines, label: str) -> list[str]:
    """The words after a label, which a file may have written without a blank."""
    words = lines.words()
    line = " ".join(words)
    if line[: len(label)].upper() != label.upper():
        raise lines.expected(words, what=f"{label} and a number")
    rest = line[len(label) :]
    if rest and not rest.startswith(" "):
        lines.irregular.append(f"Line {lines.number}: there is no blank after {label!r}.")
    return rest.split()


def _frames(lines: _Lines, channels: int, announced: int) -> "tuple[int, array[float]]":
    """Number of frames, and their values; a frame begins on a line of its own."""
    numbers = array("d")
    frames = begun = wrapped = 0
    frame: list[float] = []
    for number, words in lines.rows():
        if frames > announced:
            raise _error(
                code="bvh-unreadable",
                reason=f"Line {number}: more frames than the {announced} that were announced.",
            )
        begun = begun if frame else number
        try:
            frame += map(float, words)
        except ValueError:
            frame = [math.nan]
        if len(frame) > channels or not _can_be_meant(frame):
            raise _no_frame(begun, frames, channels, len(words) if begun == number else len(frame))
        if len(frame) == channels:
            wrapped = wrapped or (begun if begun < number else 0)
            numbers.extend(frame)
            frames += 1
            frame = []
    if frame:
        raise _no_frame(begun, frames, channels, len(frame))
    if wrapped:
        lines.irregular.append(
            f"Line {wrapped}: the numbers of a frame are spread over several lines."
        )
    return frames, numbers


def _no_frame(line: int, frames: int, channels: int, words: int) -> InvalidInputError:
    return _error(
        code="bvh-unreadable",
        reason=f"Line {line}: frame {frames + 1} is not {channels} finite numbers, one a channel; "
        f"it has {words} words.",
    )


def _can_be_meant(numbers: list[float]) -> bool:
    """Whether all are finite and of a size that may be meant."""
    # A sum shows what is not finite, which comparisons do not.
    return (
        math.isfinite(sum(numbers))
        and max(numbers) <= LARGEST_NUMBER
        and min(numbers) >= -LARGEST_NUMBER
    )


def _error(*, code: str, reason: str) -> InvalidInputError:
    remedies = {
        "bvh-too-large": "Send one person's skeleton and a shorter clip.",
        "bvh-too-long": "Cut the clip, or leave out every second frame.",
        "bvh-unreadable": "Export the motion again as BVH, as text.",
        "not-a-bvh": "Export the motion as BVH.",
    }
    return InvalidInputError(code=code, field=FIELD, reason=reason, remedy=remedies[code])
