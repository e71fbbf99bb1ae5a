"""MakeHuman's neutral bodies with the rig that poses them, made once for all tests."""

from functools import cache

import numpy as np

from fitter.training.articulation.rig import Rig, load_rig
from fitter.training.articulation.rigged_bodies import (
    RegisteredBodies,
    RiggedMesh,
    rigged_bodies,
    rigged_mesh,
)
from fitter.training.articulation.shoulder_girdle import with_shoulder_girdle
from fitter.training.makehuman.body_space import Traits, source_vertices
from fitter.training.makehuman.meshes import makehuman_folder
from fitter.training.makehuman.phenotypes import FACE_CHANGES
from tests.unit.training.makehuman_data import base_mesh, body_space

NEUTRAL = Traits(age=0.5, ancestry=np.full(3, 1.0 / 3.0), face=np.zeros(len(FACE_CHANGES)))


@cache
def rig() -> Rig:
    """As MakeHuman paints it."""
    base = base_mesh()
    return load_rig(makehuman_folder(), base.groups, len(base.source_vertices))


@cache
def mesh() -> RiggedMesh:
    return rigged_mesh(base_mesh(), with_shoulder_girdle(rig(), base_mesh()))


@cache
def neutral_source() -> np.ndarray:
    """(v, 3) source vertices of the neutral woman at rest."""
    space = body_space("female")
    return source_vertices(space, NEUTRAL, space.neutral)


@cache
def neutral_body() -> RegisteredBodies:
    return rigged_bodies(mesh(), neutral_source()[None])
