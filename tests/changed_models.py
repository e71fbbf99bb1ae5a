"""Model files that lack something, made of the packaged woman."""

from functools import cache
from pathlib import Path

import numpy as np

from fitter.body.model import BodyModel, SparseRows
from fitter.body.storage import load_body_model, packaged_model_path, save_body_model
from fitter.training.assemble import model_arrays


@cache
def packaged() -> BodyModel:
    return load_body_model(packaged_model_path("female"))


def save(path: Path, model: BodyModel) -> None:
    header = dict(model.header) | {
        "part_names": list(model.part_names),
        "landmark_names": list(model.landmarks.names),
    }
    save_body_model(path, header=header, arrays=model_arrays(model))


def without(rows: SparseRows, name: str) -> SparseRows:
    kept = np.repeat(np.array(rows.names) != name, np.diff(rows.pointers))
    lengths = [
        length
        for other, length in zip(rows.names, np.diff(rows.pointers), strict=True)
        if other != name
    ]
    return SparseRows(
        names=tuple(other for other in rows.names if other != name),
        pointers=np.cumsum([0, *lengths]),
        indices=rows.indices[kept],
        weights=rows.weights[kept],
    )
