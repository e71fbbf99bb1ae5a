"""The fitter for notebooks: functions that load the body model for the person's gender.

:func:`fitter.fits.pipeline.fit` fits a picture. These work on its result, or without a picture at
all. ``models`` is always the folder with the body models, None for those of the package.
"""

from collections.abc import Mapping
from pathlib import Path

from fitter.arrays import Triangles, Vertices
from fitter.export import artifacts
from fitter.fits.prepared_model import prepared_model
from fitter.measurement.anthropometry import measure as measure_shape
from fitter.measurement.quantity import Measurement
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson, require_model
from fitter.population import body_estimate
from fitter.population.body_estimate import BodyEstimate
from fitter.request import Gender, KnownMeasurement
from fitter.result import FitResult


def measure(person: FittedPerson, *, models: Path | None = None) -> tuple[Measurement, ...]:
    """All measurements of a fitted person, with standard errors where the fit has a covariance.

    Those of :class:`~fitter.result.FitResult` also know which ones the caller gave.

    Raises
    ------
    InvalidInputError
        If the person was fitted with another body model.
    ModelFileError
        If the body model is missing or damaged.

    Examples
    --------
    >>> from fitter import measure
    >>> waist = {each.name: each for each in measure(result.person)}["waist_girth_navel"]
    >>> waist.unit.value, 60.0 < waist.value < 120.0
    ('cm', True)
    """
    prepared = prepared_model(person.gender, models=models)
    require_model(person, prepared.operators.model)
    return measure_shape(
        prepared.measuring, person.body.shape, shape_covariance=person.shape_covariance
    )


def estimate_body(
    gender: Gender, known: Mapping[str, float | KnownMeasurement], *, models: Path | None = None
) -> BodyEstimate:
    """The most probable body with known measurements, without a picture.

    Parameters
    ----------
    gender
        Whose population.
    known
        By measurement name, in its unit (``stature`` in cm, ``weight`` in kg); none to all.
    models
        Folder of the body models.

    Raises
    ------
    InvalidInputError
        If a name is not a measurement, or nobody has such measurements.

    Examples
    --------
    >>> from fitter import Gender, estimate_body
    >>> estimate = estimate_body(Gender.FEMALE, {"stature": 170.0, "weight": 65.0})
    >>> heights = {each.measurement.name: each.measurement.value for each in estimate.measurements}
    >>> round(heights["stature"], 3)
    170.0
    """
    exactly = {
        name: value if isinstance(value, KnownMeasurement) else KnownMeasurement(value=value)
        for name, value in known.items()
    }
    return body_estimate.estimate_body(prepared_model(gender, models=models).population, exactly)


def body_vertices(
    gender: Gender, body: BodyParameters, *, models: Path | None = None
) -> tuple[Vertices, Triangles]:
    """A body in its pose (SCAPE, section 3), before the camera.

    Returns
    -------
    tuple
        (m, 3) vertices in the camera frame (OpenCV axes), metres, and (f, 3) triangles.

    Raises
    ------
    ModelFileError
        If the body model is missing or damaged.

    Examples
    --------
    >>> import numpy as np
    >>> from fitter import body_vertices
    >>> vertices, triangles = body_vertices(result.person.gender, result.person.body)
    >>> bool(np.abs(vertices - result.found.posed_vertices).max() < 1e-9)
    True
    """
    operators = prepared_model(gender, models=models).operators
    return operators.evaluator.vertices(body), operators.model.triangles


def files_of(result: FitResult, image: bytes, *, models: Path | None = None) -> dict[str, bytes]:
    """Every file of a fit by name: GLB meshes and pictures drawn over the encoded ``image``.

    Raises
    ------
    ModelFileError
        If the body model is missing or damaged.

    Examples
    --------
    >>> from fitter import files_of
    >>> files_of(result, picture)["body_posed.glb"][:4]
    b'glTF'
    """
    model = prepared_model(result.person.gender, models=models).operators.model
    return artifacts(result, model=model, image=image)
