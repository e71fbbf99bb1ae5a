"""A shoulder girdle for MakeHuman's rig: arms that are raised lift the shoulders.

As painted, the skin of shoulder and upper back follows the spine, and collar bone and shoulder
blade have little of it. They turn with an arm, but the skin over them stays, so that an arm
overhead stands in a pit between neck and deltoid. In a person the shoulder comes up to the chin: of
a raised arm's half turn the blade takes a third, the collar bone some 30 degrees (Inman, Saunders
and Abbott 1944, "Observations on the function of the shoulder joint"). So here

- trunk skin toward the shoulder follows collar bone and blade, the more the farther out;
- the cap of the shoulder follows the blade in part, in place of the arm;
- both bones take more of an arm's swing where it is raised high
  (:mod:`fitter.training.articulation.rig_drives`), and as much as before where it is not.

Places are told on the base mesh, by two coordinates of a vertex: *out*, its way from the inner end
of the collar bone (0) to the shoulder joint (1) along the line that joins them, and *up*, its
height above the shoulder joint.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy import sparse

from fitter.training.articulation.rig import Rig
from fitter.training.articulation.rig_drives import smooth_step
from fitter.training.makehuman.meshes import BaseMesh

RAISED_SWING: Mapping[str, float] = {"clavicle": 0.12, "shoulder01": 0.15}
"""Additional shares of the swing of an arm overhead: 34 and 62 degrees of 125 in all."""

TRUNK_BONES = ("spine03", "spine02", "spine01", "neck02", "neck01")
ARM_BONES = ("upperarm01", "upperarm02")

TRUNK_SKIN_GIVEN = 0.9
TRUNK_OUT, TRUNK_UP_M = (0.2, 1.0), (-0.14, 0.0)
"""Ranges over which the share of trunk skin given to the girdle grows from none to all of it."""

BLADE_OUT = (0.45, 0.95)
"""Range over which that skin goes over from collar bone to blade."""

CAP_GIVEN = 0.6
CAP_OUT, CAP_UP_M = (0.9, 2.3), (-0.05, 0.03)
"""Ranges over which the share of arm skin that follows the blade falls to none, and begins. A
larger share, or one that falls faster, leaves a dent in the deltoid of an arm overhead."""


def with_shoulder_girdle(rig: Rig, base: BaseMesh) -> Rig:
    """The rig with shoulders that follow raised arms."""
    names = rig.bone_names
    heads = rig.head_rows @ base.source_vertices
    weights = rig.weights.toarray()
    trunk = [names.index(name) for name in TRUNK_BONES]
    for side, outward in (("L", 1.0), ("R", -1.0)):
        collar, blade = names.index(f"clavicle.{side}"), names.index(f"shoulder01.{side}")
        arm = [names.index(f"{name}.{side}") for name in ARM_BONES]
        line = heads[arm[0]] - heads[collar]
        out = (base.source_vertices - heads[collar]) @ line / (line @ line)
        up = base.source_vertices[:, 1] - heads[arm[0], 1]
        own = outward * base.source_vertices[:, 0] > 0.0
        high = np.where(own, _grown(up, TRUNK_UP_M), 0.0)
        cap = np.where(own, _grown(up, CAP_UP_M) * (1.0 - _grown(out, CAP_OUT)), 0.0)
        _give(weights, trunk, collar, TRUNK_SKIN_GIVEN * high * _grown(out, TRUNK_OUT))
        _give(weights, [collar], blade, high * _grown(out, BLADE_OUT))
        _give(weights, arm, blade, CAP_GIVEN * cap)
    raised = [RAISED_SWING.get(name.partition(".")[0], 0.0) for name in names]
    return replace(
        rig,
        weights=sparse.csr_array(weights),
        drives=replace(rig.drives, raised_swing=np.array(raised)),
    )


def _grown(place: Float[np.ndarray, " v"], between: tuple[float, float]) -> Float[np.ndarray, " v"]:
    """0 before, 1 after, smooth in between."""
    start, end = between
    return smooth_step((place - start) / (end - start))


def _give(
    weights: Float[np.ndarray, "v b"], givers: list[int], taker: int, share: Float[np.ndarray, " v"]
) -> None:
    """Hand a share of some bones' weights to another, in place."""
    given = share[:, None] * weights[:, givers]
    weights[:, givers] -= given
    weights[:, taker] += given.sum(axis=1)
