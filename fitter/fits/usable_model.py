"""A gender's body model as its file holds it, with all the names a fit needs.

It is enough to say which models there are, and that they can be used. Preparing one for fits
(:mod:`fitter.fits.equipment`) takes ten times as long, and the compiled kernels.
"""

from pathlib import Path

from fitter.body.joint_limits import JOINT_RANGES
from fitter.body.model import BodyModel
from fitter.body.storage import load_body_model, packaged_model_path
from fitter.errors import ModelFileError
from fitter.measurement.definitions import JOINT_PREFIX, load_definitions, needed_points
from fitter.vocabulary.choices import Gender
from fitter.vocabulary.points import POINT_NAMES

_MIDDLE_PARTS = ("pelvis", "spine", "chest", "neck", "head")

NEEDED_PARTS = (
    *_MIDDLE_PARTS,
    *(
        f"{side}_{limb}"
        for side in ("left", "right")
        for limb in JOINT_RANGES
        if limb not in _MIDDLE_PARTS
    ),
)
"""Parts by which joints have limits, limbs are lifted and outlines are trusted."""


def usable_model(gender: Gender, *, models: Path | None = None) -> BodyModel:
    """A gender's model, loaded and checked.

    Parameters
    ----------
    gender
        Whose model.
    models
        Folder with ``female.npz`` or ``male.npz``; None takes the models shipped with the package.

    Raises
    ------
    ModelFileError
        If the file is missing, damaged, of the other gender, or lacks something a fit needs.
    """
    path = model_path(gender, models=models)
    model = load_body_model(path, gender=gender.value)
    _check_names(path, model)
    return model


def model_path(gender: Gender, *, models: Path | None = None) -> Path:
    """The file of a gender's model in a folder, or in the package."""
    packaged = packaged_model_path(gender.value)
    return packaged if models is None else models / packaged.name


def needed_landmarks() -> tuple[str, ...]:
    """Landmarks a fit needs: those that can be clicked, and those measurements are defined by."""
    measured = (
        point
        for definition in load_definitions()
        for point in needed_points(definition)
        if not point.startswith(JOINT_PREFIX)
    )
    return tuple(dict.fromkeys((*POINT_NAMES, *measured)))


def _check_names(path: Path, model: BodyModel) -> None:
    for field, needed, found in (
        ("header.part_names", NEEDED_PARTS, model.part_names),
        ("header.landmark_names", needed_landmarks(), model.landmarks.names),
    ):
        missing = [name for name in needed if name not in found]
        if missing:
            raise ModelFileError(
                file=path.name,
                field=field,
                reason=f"lacks what a fit needs: {', '.join(missing)}",
                remedy="Train the model again with a template that has them (OWN_BODIES.md).",
            )
