"""Whether loose clothes hide the legs, by how far the outline stands off their bones.

The outer side alone is looked at, for a leg's inner side may meet the other leg; and legs alone,
because arms and trunks of heavy people in underwear are as broad as those of thin ones in shirts.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Mask
from fitter.capture.capture import Capture
from fitter.capture.finding import Code, Finding, Remark, Severity, Unchecked
from fitter.capture.turning import is_broadside

LOOSE = 1.2
"""From how many times as far off the bone as of any bare leg the outline is that of loose clothes.

Of 53 pictures of the tuning half in underwear 1.0 is the most, of four in loose clothes 1.4 the
least."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Level:
    """A level of the leg and how far bare legs reach there, outward from the bone.

    Attributes
    ----------
    near, far
        Ends of the bone.
    along
        Where on the bone, from 0 at the near end.
    bare
        The most there is of bare legs, as a share of the stature, the mean of both legs.
    """

    name: str
    near: str
    far: str
    along: float
    bare: float


LEVELS = (
    Level(name="thighs", near="hip", far="knee", along=0.6, bare=0.057),
    Level(name="knees", near="hip", far="knee", along=0.9, bare=0.045),
    Level(name="lower shins", near="knee", far="ankle", along=0.75, bare=0.03),
)

_FARTHEST = 0.2
_STEP_PX = 0.5


def clothes(capture: Capture) -> Remark | None:
    """Whether the outline stands farther off the legs than any bare leg's."""
    if capture.mask is None or capture.stature_px is None:
        return Unchecked(code=Code.CLOTHES_LOOSE, reason="Without a detector there is no outline.")
    if not is_broadside(capture):
        return Unchecked(
            code=Code.CLOTHES_LOOSE,
            reason="Only from the front or from behind are legs seen beside each other.",
        )
    found = {
        level: share
        for level in LEVELS
        if (share := outward_share(capture, capture.mask, capture.stature_px, level)) is not None
    }
    if not found:
        return Unchecked(code=Code.CLOTHES_LOOSE, reason="Legs are crossed or not in the picture.")
    level = max(found, key=lambda each: found[each] / each.bare)
    if found[level] < LOOSE * level.bare:
        return None
    return Finding(
        code=Code.CLOTHES_LOOSE,
        severity=Severity.HARMS,
        reason=(
            f"At the {level.name} the outline is {100.0 * capture.height_m * found[level]:.1f} cm "
            f"off the bone, and a bare leg's at most {100.0 * capture.height_m * level.bare:.1f}."
        ),
        remedy="Have tight clothes worn, or say with the fit that `clothing` is `loose`.",
        points=tuple(
            f"{side}_{end}" for side in ("left", "right") for end in (level.near, level.far)
        ),
    )


def outward_share(capture: Capture, mask: Mask, stature_px: float, level: Level) -> float | None:
    """How far the outline is off the bones at a level, outward, of the stature; mean of both legs.

    None if a joint is missing or the legs are crossed there.
    """
    if any(name not in capture.joints for name in _ends(level)):
        return None
    left_near, left_far, right_near, right_far = (capture.joints[name] for name in _ends(level))
    left = left_near + level.along * (left_far - left_near)
    right = right_near + level.along * (right_far - right_near)
    # From the right leg to the left one, as at the hips; crossed legs have it the other way round.
    outward = capture.joints["left_hip"] - capture.joints["right_hip"]
    if float((left - right) @ outward) <= 0.0:
        return None
    reaches = [
        _reach(mask, place, _across(far - near, away), _FARTHEST * stature_px)
        for place, near, far, away in (
            (left, left_near, left_far, outward),
            (right, right_near, right_far, -outward),
        )
    ]
    return float(np.mean(reaches)) / stature_px


def _ends(level: Level) -> tuple[str, ...]:
    return tuple(f"{side}_{end}" for side in ("left", "right") for end in (level.near, level.far))


def _across(bone: Float[np.ndarray, "2"], away: Float[np.ndarray, "2"]) -> Float[np.ndarray, "2"]:
    """The direction perpendicular to a bone, on the side of ``away``."""
    across = np.array([-bone[1], bone[0]]) / max(float(np.linalg.norm(bone)), 1e-9)
    return across if float(across @ away) >= 0.0 else -across


def _reach(
    mask: Mask, start: Float[np.ndarray, "2"], along: Float[np.ndarray, "2"], most: float
) -> float:
    """How far the mask goes on from a place in a direction, pixels."""
    height, width = mask.shape
    distances = np.arange(0.0, most, _STEP_PX)
    columns, rows = np.floor(start + distances[:, None] * along).astype(int).T
    inside = (columns >= 0) & (columns < width) & (rows >= 0) & (rows < height)
    covered = np.zeros(len(distances), bool)
    covered[inside] = mask[rows[inside], columns[inside]]
    return _STEP_PX * float(np.argmin(covered)) if not covered.all() else most
