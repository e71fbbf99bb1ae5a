"""The fitter for notebooks: functions, with the body models and the detector of the packages.

An :class:`~fitter.fits.equipment.Equipment` names other folders; each is loaded once, when first
needed.
"""

from collections.abc import Mapping

from fitter.arrays import Triangles, Vertices
from fitter.export import result_files
from fitter.fits import pipeline
from fitter.fits.equipment import PACKAGED, Equipment
from fitter.fits.progress import Observer, ignore_progress
from fitter.measurement.anthropometry import measure as measure_shape
from fitter.measurement.definitions import Measurement
from fitter.parameters import BodyParameters
from fitter.person.fitted_person import FittedPerson, require_model
from fitter.population import body_estimate
from fitter.population.body_estimate import BodyEstimate
from fitter.request import FitRequest, KnownMeasurement
from fitter.result import FitResult
from fitter.vocabulary.choices import Gender


def fit(
    request: FitRequest, *, equipment: Equipment = PACKAGED, observer: Observer = ignore_progress
) -> FitResult:
    """Fit a body to one to six pictures of a person.

    ``observer`` receives the progress.

    Raises
    ------
    InvalidInputError
        If the request cannot be used; the message names the field and the remedy. Of several
        pictures, what is at fault in one has a field that begins with ``views.NUMBER``.
    ModelFileError
        If the body model is missing or damaged, or lacks something a fit needs.
    DetectorUnavailableError
        If points are to be proposed and the detector is not installed.

    Examples
    --------
    >>> from fitter import Click, FitRequest, Gender, Person, View, fit
    >>> points = {name: Click(x=x, y=y) for name, (x, y) in clicks.items()}
    >>> person = Person(gender=Gender(gender), height_m=height_m)
    >>> result = fit(FitRequest(person=person, views=(View(image=picture, clicks=points),)))
    >>> result.found.outcome.value, result.found.silhouette_overlap > 0.9
    ('converged', True)
    >>> waist = {each.name: each for each in result.measurements}["waist_girth_navel"]
    >>> waist.unit.value, 60.0 < waist.value < 120.0
    ('cm', True)
    >>> result.canonical_vertices.shape[1], result.triangles.shape[1]
    (3, 3)
    """
    return pipeline.fit(request, equipment, observer=observer)


def measure(person: FittedPerson, *, equipment: Equipment = PACKAGED) -> tuple[Measurement, ...]:
    """All measurements of a fitted person, with standard errors where the fit has a covariance.

    For people read from ``person.npz``: those of :class:`~fitter.result.FitResult` are there
    already, and know which ones the caller gave.

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
    prepared = equipment.model(person.gender)
    require_model(person, prepared.operators.model)
    return measure_shape(
        prepared.measuring, person.body.shape, shape_covariance=person.shape_covariance
    )


def estimate_body(
    gender: Gender,
    known: Mapping[str, float | KnownMeasurement],
    *,
    equipment: Equipment = PACKAGED,
) -> BodyEstimate:
    """The most probable body with known measurements, without a picture.

    Parameters
    ----------
    gender
        Whose population.
    known
        By measurement name, in its unit (``stature`` in cm, ``weight`` in kg); none to all.

    Raises
    ------
    InvalidInputError
        If a name is not a measurement, or nobody has such measurements.

    Examples
    --------
    >>> from fitter import Gender, estimate_body
    >>> estimate = estimate_body(Gender.FEMALE, {"stature": 170.0, "weight": 65.0})
    >>> heights = {each.name: each.value for each in estimate.measurements}
    >>> round(heights["stature"], 3)
    170.0
    """
    exactly = {
        name: value if isinstance(value, KnownMeasurement) else KnownMeasurement(value=value)
        for name, value in known.items()
    }
    return body_estimate.estimate_body(equipment.model(gender).population, exactly)


def body_vertices(
    gender: Gender, body: BodyParameters, *, equipment: Equipment = PACKAGED
) -> tuple[Vertices, Triangles]:
    """A body in its pose (SCAPE, section 3), before the camera.

    For bodies that are posed or shaped otherwise: a fit's own are in its result.

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
    operators = equipment.model(gender).operators
    return operators.evaluator.vertices(body), operators.model.triangles


def files_of(
    result: FitResult, *images: bytes, equipment: Equipment = PACKAGED
) -> dict[str, bytes]:
    """Every file of a fit by name: GLB meshes, and pictures drawn over the encoded ``images``.

    The ``images`` are in the order of the request; the names of what belongs to one begin with its
    place there (``views/0/overlay.png``).

    Raises
    ------
    ModelFileError
        If the body model is missing or damaged.

    Examples
    --------
    >>> from fitter import files_of
    >>> files_of(result, picture)["views/0/body_posed.glb"][:4]
    b'glTF'
    """
    model = equipment.model(result.person.gender).operators.model
    return result_files(result, model=model, images=images)
