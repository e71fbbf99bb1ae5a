"""The body before any picture is looked at: what clicks, gender, height and camera say (3.1)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from fitter.arrays import Vertices
from fitter.body.model import regress
from fitter.fits.equipment import PreparedModel
from fitter.fits.reporting import AMBIGUOUS_NATS
from fitter.observation.clicks import check_clicks, side_warnings
from fitter.observation.focal_length import focal_length
from fitter.observation.picture_files import ExifTags
from fitter.observation.pixels import working_size
from fitter.observation.subject import check_person
from fitter.parameters import BodyParameters
from fitter.population.known_person import known_person
from fitter.pose_init.click_problem import clicked_points
from fitter.pose_init.initial_pose import PoseHypothesis, initialize_pose
from fitter.render.camera import Camera
from fitter.render.contours import outline_loops
from fitter.render.rasterizer import render
from fitter.request import Person, View
from fitter.vocabulary.choices import Facing
from fitter.vocabulary.outcomes import FacingSource, FocalLengthSource, LimbFacing
from fitter.vocabulary.points import POINT_NAMES
from fitter.vocabulary.remarks import Remark


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InitialBody:
    """The body a fit would start from.

    Attributes
    ----------
    height_m
        The caller's, or else the most probable, which is then listed in ``assumptions``.
    camera
        The camera of the whole picture.
    body
        Pose, position, and the mean shape for the height and the known measurements.
    vertices
        (m, 3) camera frame, metres.
    outline
        Closed lines around the silhouette and its holes, continuous pixels of the whole picture.
    landmarks
        Where the body's clickable points project, by name, continuous pixels.
    limbs
        The readings of all limbs.
    residual_px
        Distance of each click to the body's landmark.
    """

    height_m: float
    camera: Camera
    focal_length_source: FocalLengthSource
    body: BodyParameters
    vertices: Vertices
    outline: tuple[Float[np.ndarray, "_ 2"], ...]
    landmarks: Mapping[str, Float[np.ndarray, "2"]]
    limbs: tuple[LimbFacing, ...]
    residual_px: Mapping[str, float]
    assumptions: tuple[Remark, ...]
    warnings: tuple[Remark, ...]


def initial_body(
    person: Person,
    view: View,
    prepared: PreparedModel,
    *,
    width: int,
    height: int,
) -> InitialBody:
    """Pose the mean person of the gender, height and known measurements to match the clicks.

    Parameters
    ----------
    person, view
        As for a fit; the picture itself is not used and may be empty.
    prepared
        The body model of the gender.
    width, height
        Size of the upright picture, pixels.

    Raises
    ------
    InvalidInputError
        If clicks, height, measurements or focal length cannot be used.
    """
    check_person(person)
    check_clicks(view.clicks, width=width, height=height)
    focal = focal_length(
        view,
        ExifTags(),
        width=width,
        height=height,
        stored_width=width,
    )
    camera = Camera(
        focal_length_px=focal.pixels,
        centre_x=width / 2,
        centre_y=height / 2,
        width=width,
        height=height,
    )
    evaluator = prepared.operators.evaluator
    known = known_person(person, prepared.population, evaluator)
    initial = initialize_pose(
        evaluator,
        camera=camera,
        clicks=clicked_points(view.clicks),
        shape=known.shape,
        limb_facing=view.limb_facing,
    )
    vertices = evaluator.vertices(initial.parameters)
    landmarks = prepared.operators.model.landmarks
    projected = dict(
        zip(landmarks.names, camera.project(regress(landmarks, vertices)), strict=True)
    )
    return InitialBody(
        height_m=known.height_m,
        camera=camera,
        focal_length_source=focal.source,
        body=initial.parameters,
        vertices=vertices,
        outline=_outline(vertices, prepared, camera),
        landmarks={name: projected[name] for name in POINT_NAMES},
        limbs=limb_readings(initial.hypotheses, view.limb_facing),
        residual_px=initial.residual_px,
        assumptions=focal.assumptions + known.assumptions,
        warnings=side_warnings(view.clicks) + known.warnings,
    )


def limb_readings(
    hypotheses: Sequence[PoseHypothesis], said: Mapping[str, Facing]
) -> tuple[LimbFacing, ...]:
    """Differences in each limb between readings of the clicks, best first."""
    best = hypotheses[0]
    readings: list[LimbFacing] = []
    for limb, facing in best.facing.items():
        others = [
            hypothesis.energy - best.energy
            for hypothesis in hypotheses
            if hypothesis.facing[limb] is not facing
        ]
        nearest = min(others) if others and limb not in said else None
        readings.append(
            LimbFacing(
                limb=limb,
                facing=facing,
                source=FacingSource.CALLER if limb in said else FacingSource.PRIOR,
                ambiguous=nearest is not None and nearest < AMBIGUOUS_NATS,
                alternative_nats=None if nearest is None else round(nearest, 2),
            )
        )
    return tuple(readings)


def _outline(
    vertices: Vertices, prepared: PreparedModel, camera: Camera
) -> tuple[Float[np.ndarray, "_ 2"], ...]:
    """Found at the working size, returned in pixels of the whole picture."""
    size = working_size(width=camera.width, height=camera.height)
    coarse = camera.scaled(size.scale, width=size.width, height=size.height)
    rendering = render(vertices, prepared.operators.model.triangles, coarse)
    return tuple(loop / size.scale for loop in outline_loops(rendering.silhouette))
