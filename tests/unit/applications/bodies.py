"""The packaged bodies that the tests of the applications pose."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from fitter.applications.poses import Rig, rig_of
from fitter.arrays import Pose, Shape, Vertices
from fitter.body.model import BodyModel
from fitter.body.scape import ScapeEvaluator
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.parameters import BodyParameters


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Body:
    model: BodyModel
    evaluator: ScapeEvaluator
    shape: Shape
    rig: Rig

    def vertices(self, pose: Pose) -> Vertices:
        parameters = BodyParameters(pose=pose, translation=np.zeros(3), shape=self.shape)
        return self.evaluator.body_frame_vertices(parameters)


@cache
def packaged(gender: str) -> Body:
    """A person of the population, chosen by seed."""
    model = load_body_model(packaged_model_path(gender))
    shape = np.random.default_rng(7).normal(size=len(model.shape_basis))
    return Body(
        model=model,
        evaluator=ScapeEvaluator(model),
        shape=shape,
        rig=rig_of(model, shape),
    )
