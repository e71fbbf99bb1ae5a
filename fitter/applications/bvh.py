"""Motion from a BVH file: a skeleton at rest, and its joints' rotations frame by frame.

A file has a HIERARCHY of joints (OFFSET from the parent, CHANNELS in the order in which numbers
come) and a MOTION of frames. Three rotation channels are Euler angles in degrees, intrinsic in the
order listed: ``Zrotation Xrotation Yrotation`` is R = Rz Rx Ry. Every error names the line.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Integer
from numpy.typing import ArrayLike

from fitter.errors import InvalidInputError
from fitter.numerics.rotations import rotation_matrices

MAX_BYTES = 32 * 2**20
MAX_FRAMES = 20_000
"""Nearly three minutes at 120 Hz."""

MAX_JOINTS = 512
FRAME_TIMES_S = (1e-5, 10.0)
"""No recording has more frames a second, or fewer."""

LARGEST_NUMBER = 1e9
"""Beyond it no length and no angle is meant; far below where squares overflow."""

_AXES = {"X": 0, "Y": 1, "Z": 2}
_CHANNELS = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in _AXES)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BvhClip:
    """A clip, in the file's axes and unit of length.

    Attributes
    ----------
    names
        Of the j joints, parents before children; ends of chains have no name and are not among
        them.
    parent
        (j,) -1 for the root.
    offsets
        (j, 3) from the parent, at rest.
    ends
        (e, 3) offsets of the chains' ends, ``end_parent`` (e,) the joints they belong to.
    frame_time_s
        Seconds from frame to frame.
    channels
        Of each joint, in the order of the columns of ``numbers``.
    numbers
        (t, c) as in the file: lengths, and degrees.
    """

    names: tuple[str, ...]
    parent: Integer[np.ndarray, " j"]
    offsets: Float[np.ndarray, "j 3"]
    ends: Float[np.ndarray, "e 3"]
    end_parent: Integer[np.ndarray, " e"]
    frame_time_s: float
    channels: tuple[tuple[str, ...], ...]
    numbers: Float[np.ndarray, "t c"]

    def rest_positions(self) -> Float[np.ndarray, "j 3"]:
        """Where the joints are at rest, the root at its offset."""
        positions = self.offsets.copy()
        for joint, parent in enumerate(self.parent):
            if parent >= 0:
                positions[joint] += positions[parent]
        return positions

    def motion(
        self, frames: slice
    ) -> tuple[Float[np.ndarray, "t j 3 3"], Float[np.ndarray, "t j 3"]]:
        """Global rotations from rest and positions of the joints in some of the frames."""
        numbers = self.numbers[frames]
        rotations = np.empty((len(numbers), len(self.names), 3, 3))
        positions = np.empty((len(numbers), len(self.names), 3))
        column = 0
        for joint, (parent, channels) in enumerate(zip(self.parent, self.channels, strict=True)):
            turn = np.broadcast_to(np.eye(3), (len(numbers), 3, 3))
            place = np.tile(self.offsets[joint], (len(numbers), 1))
            for channel in channels:
                values = numbers[:, column]
                axis = _AXES[channel[0]]
                column += 1
                if channel.endswith("position"):
                    # In place of the offset, as the programs that write such files do.
                    place[:, axis] = values
                else:
                    turns = np.zeros((len(values), 3))
                    turns[:, axis] = np.radians(values)
                    turn = turn @ rotation_matrices(turns)
            if parent < 0:
                rotations[:, joint], positions[:, joint] = turn, place
            else:
                rotations[:, joint] = rotations[:, parent] @ turn
                positions[:, joint] = positions[:, parent] + np.einsum(
                    "tij,tj->ti", rotations[:, parent], place
                )
        return rotations, positions


@dataclass(frozen=True, slots=True, kw_only=True)
class _Joint:
    name: str | None
    parent: int
    offset: tuple[float, float, float]
    channels: tuple[str, ...]


def parse_bvh(content: bytes, *, field: str = "bvh") -> BvhClip:
    """Read a BVH file.

    Parameters
    ----------
    content
        Of the file; UTF-8 or any encoding that agrees with ASCII.
    field
        The request field errors name.

    Raises
    ------
    InvalidInputError
        If it is too large, no BVH, or says something impossible; with the line.
    """
    if len(content) > MAX_BYTES:
        raise _error(
            field=field,
            code="bvh-too-large",
            reason=f"The file has {len(content)} bytes, more than {MAX_BYTES}.",
        )
    lines = content.decode("utf-8", errors="replace").splitlines()
    reader = _Reader(lines, field)
    nodes = list(_hierarchy(reader))
    joints = [node for node in nodes if node.name is not None]
    ends = [node for node in nodes if node.name is None]
    frame_time_s, numbers = _motion(reader, sum(len(joint.channels) for joint in joints))
    return BvhClip(
        names=tuple(str(joint.name) for joint in joints),
        parent=np.array([joint.parent for joint in joints], dtype=np.int32),
        offsets=np.array([joint.offset for joint in joints], dtype=np.float64),
        ends=np.array([end.offset for end in ends], dtype=np.float64).reshape(-1, 3),
        end_parent=np.array([end.parent for end in ends], dtype=np.int32),
        frame_time_s=frame_time_s,
        channels=tuple(joint.channels for joint in joints),
        numbers=numbers,
    )


class _Reader:
    """The lines that are not blank, one after the other, with their numbers."""

    def __init__(self, lines: list[str], field: str) -> None:
        self._lines = lines
        self._field = field
        self.number = 0

    def words(self) -> list[str]:
        """The words of the next line that has any; none at the file's end."""
        while self.number < len(self._lines):
            self.number += 1
            words = self._lines[self.number - 1].split()
            if words:
                return words
        return []

    def rest(self) -> Iterator[tuple[int, str]]:
        """The lines not read yet that have words, with their numbers."""
        for number in range(self.number + 1, len(self._lines) + 1):
            line = self._lines[number - 1]
            if line.strip():
                yield number, line

    def expected(self, words: list[str], *, what: str) -> InvalidInputError:
        found = f"found {' '.join(words)[:60]!r}" if words else "the file ends"
        return self.error(
            code="bvh-unreadable", reason=f"Line {self.number}: {found}, expected {what}."
        )

    def error(self, *, code: str, reason: str) -> InvalidInputError:
        return _error(field=self._field, code=code, reason=reason)


def _hierarchy(reader: _Reader) -> Iterator[_Joint]:
    words = reader.words()
    if [word.upper() for word in words] != ["HIERARCHY"]:
        raise reader.expected(words, what="HIERARCHY, with which a BVH file begins")
    words = reader.words()
    if len(words) < 2 or words[0].upper() != "ROOT":
        raise reader.expected(words, what="ROOT and a name")
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
            joint = _joint(reader, " ".join(words[1:]), open_joints[-1] if open_joints else -1)
            if joint.name in names:
                raise reader.error(
                    code="bvh-unreadable",
                    reason=f"Line {reader.number}: a second joint has the name {joint.name!r}.",
                )
            if len(names) == MAX_JOINTS:
                raise reader.error(
                    code="bvh-too-large",
                    reason=f"Line {reader.number}: the skeleton has more than {MAX_JOINTS} joints.",
                )
            open_joints.append(len(names))
            names.add(str(joint.name))
            yield joint
        elif kind == "END" and open_joints and open_joints[-1] >= 0:
            yield _end(reader, open_joints[-1])
            open_joints.append(-1)
        else:
            raise reader.expected(words, what="JOINT and a name, End Site or }")
        words = reader.words()


def _joint(reader: _Reader, name: str, parent: int) -> _Joint:
    offset = _offset(reader)
    words = reader.words()
    if len(words) < 2 or words[0].upper() != "CHANNELS" or not words[1].isdigit():
        raise reader.expected(words, what="CHANNELS, how many and which")
    channels = tuple(word[:1].upper() + word[1:].lower() for word in words[2:])
    if len(channels) != int(words[1]) or len(set(channels)) != len(channels):
        raise reader.expected(words, what=f"{words[1]} different channels")
    for channel in channels:
        if channel not in _CHANNELS:
            raise reader.expected(words, what=f"channels of {', '.join(_CHANNELS)}")
    return _Joint(name=name, parent=parent, offset=offset, channels=channels)


def _end(reader: _Reader, parent: int) -> _Joint:
    return _Joint(name=None, parent=parent, offset=_offset(reader), channels=())


def _offset(reader: _Reader) -> tuple[float, float, float]:
    words = reader.words()
    if words != ["{"]:
        raise reader.expected(words, what="{")
    words = reader.words()
    if len(words) != 4 or words[0].upper() != "OFFSET":
        raise reader.expected(words, what="OFFSET and three numbers")
    try:
        x, y, z = (float(word) for word in words[1:])
    except ValueError:
        raise reader.expected(words, what="OFFSET and three numbers") from None
    if not _meant([x, y, z]):
        raise reader.expected(words, what="finite numbers, of 1e9 at most")
    return x, y, z


def _motion(reader: _Reader, channels: int) -> tuple[float, Float[np.ndarray, "t c"]]:
    words = reader.words()
    if [word.upper() for word in words] != ["MOTION"]:
        raise reader.expected(words, what="MOTION")
    words = reader.words()
    if len(words) != 2 or words[0].upper() != "FRAMES:" or not words[1].isdigit():
        raise reader.expected(words, what="Frames: and a whole number")
    count = int(words[1])
    if not 1 <= count <= MAX_FRAMES:
        raise reader.error(
            code="bvh-too-long" if count else "bvh-unreadable",
            reason=f"Line {reader.number}: the clip has {count} frames, not 1 to {MAX_FRAMES}.",
        )
    words = reader.words()
    if len(words) != 3 or [word.upper() for word in words[:2]] != ["FRAME", "TIME:"]:
        raise reader.expected(words, what="Frame Time: and seconds")
    try:
        frame_time_s = float(words[2])
    except ValueError:
        raise reader.expected(words, what="Frame Time: and seconds") from None
    least, most = FRAME_TIMES_S
    if not least <= frame_time_s <= most:
        raise reader.expected(words, what=f"seconds from {least:g} to {most:g}")
    numbers = np.empty((count, channels))
    found = 0
    for number, line in reader.rest():
        if found == count:
            raise reader.error(
                code="bvh-unreadable",
                reason=f"Line {number}: more frames than the {count} that were announced.",
            )
        words = line.split()
        try:
            values = np.array(words, dtype=np.float64)
        except ValueError:
            values = np.empty(0)
        if values.shape != (channels,) or not _meant(values):
            raise reader.error(
                code="bvh-unreadable",
                reason=f"Line {number}: frame {found + 1} is not {channels} finite numbers, one a "
                f"channel; it has {len(words)} words.",
            )
        numbers[found] = values
        found += 1
    if found < count:
        raise reader.error(
            code="bvh-unreadable",
            reason=f"The file ends after {found} of the {count} frames that were announced.",
        )
    return frame_time_s, numbers


def _meant(numbers: ArrayLike) -> bool:
    """Whether all are finite and of a size that may be meant."""
    return bool((np.abs(numbers) <= LARGEST_NUMBER).all())


def _error(*, field: str, code: str, reason: str) -> InvalidInputError:
    remedies = {
        "bvh-too-large": "Send one person's skeleton and a shorter clip.",
        "bvh-too-long": "Cut the clip, or leave out every second frame.",
        "bvh-unreadable": "Export the motion again as BVH, as text.",
    }
    return InvalidInputError(code=code, field=field, reason=reason, remedy=remedies[code])
