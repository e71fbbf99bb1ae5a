"""Folders of registered bodies, made from the packaged model's own shape space."""

import json
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np

from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.shape_space import rest_vertices
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import BodyParameters
from fitter.training.articulation.poses import random_pose
from fitter.training.own_bodies.template import Template, packaged_template

DECLARED = {"source": "drawn for a test", "licence": "CC0-1.0"}


@cache
def packaged() -> BodyModel:
    return load_body_model(packaged_model_path("female"))


@cache
def evaluator() -> ScapeEvaluator:
    return ScapeEvaluator(packaged())


def template() -> Template:
    return packaged_template(packaged())


def random_shapes(count: int, axes: int = 6, seed: int = 0) -> np.ndarray:
    """Shapes that differ along the first few axes alone."""
    shapes = np.zeros((count, len(packaged().shape_basis)))
    shapes[:, :axes] = np.random.default_rng(seed).normal(size=(count, axes))
    return shapes


def write_bodies(folder: Path, shapes: np.ndarray) -> None:
    """A folder of bodies at rest, named a, b, c, ..."""
    (folder / "rest").mkdir(parents=True, exist_ok=True)
    (folder / "bodies.json").write_text(json.dumps(DECLARED))
    for k, shape in enumerate(shapes):
        np.save(folder / "rest" / f"{chr(ord('a') + k)}.npy", rest_vertices(packaged(), shape))


def write_scans(folder: Path, shapes: np.ndarray, subjects: Sequence[int]) -> None:
    """A scan of each of these subjects in a random pose."""
    rng = np.random.default_rng(1)
    for k in subjects:
        owner = folder / "posed" / chr(ord("a") + k)
        owner.mkdir(parents=True)
        np.save(owner / "scan.npy", posed_body(shapes[k], random_pose(rng)))


def posed_body(shape: np.ndarray, pose: np.ndarray) -> np.ndarray:
    parameters = BodyParameters(pose=pose, translation=np.zeros(3), shape=shape)
    return evaluator().body_frame_vertices(parameters)
