"""Landmarks of a person: the body model's own rows, taken on the true mesh."""

from collections.abc import Mapping
from functools import cache

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from fitter.body.model import BodyModel, regress
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.vocabulary.choices import Gender
from tests.accuracy.people import Person, rig_of_people

Points = Mapping[str, Float[np.ndarray, "3"]]


@cache
def packaged_model(gender: Gender) -> BodyModel:
    """The model shipped with the package, for its definitions alone."""
    return load_body_model(packaged_model_path(gender.value))


def landmarks_on(gender: Gender, body: Vertices) -> Points:
    """Landmarks by name on a body, in its frame."""
    rows = packaged_model(gender).landmarks
    return dict(zip(rows.names, regress(rows, body), strict=True))


def rest_landmarks(person: Person) -> Points:
    """Landmarks of a person at rest, body frame, metres."""
    return landmarks_on(person.gender, rig_of_people().surface.body(person.source_vertices))
