"""From a user's registered meshes to the same model file as the packaged ones."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Integer

from fitter.body.model import BodyModel
from fitter.errors import MeshFolderError
from fitter.training.assemble import ShapeSpace, learn_body_model
from fitter.training.own_bodies.figures import OwnErrors, header_entry, own_errors
from fitter.training.own_bodies.folder import LEAST_SUBJECTS, REST_FOLDER, OwnBodies, PosedScan
from fitter.training.own_bodies.part_poses import solved_pose
from fitter.training.own_bodies.pose_terms import (
    PoseTermSource,
    learned_pose_term,
    no_pose_term,
    packaged_pose_term,
)
from fitter.training.own_bodies.template import packaged_template, same_surface
from fitter.training.pose_term import PoseExample
from fitter.training.principal_shapes import centred
from fitter.training.provenance import model_statistics
from fitter.training.surface import vertex_areas, vertex_masses

LEAST_AXIS_M = 1e-4
"""An axis that moves the skin by less than this at one deviation, root mean square, is rounding:
the bodies span fewer axes than there are."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OwnPlan:
    """How a user's bodies are trained on.

    ``axes`` shape axes are wanted; ``held_out`` subjects, drawn by ``seed``, are never trained on.
    """

    axes: int
    held_out: int
    seed: int


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class OwnModel:
    """A trained model, its held-out figures, and what the user should know about it."""

    model: BodyModel
    errors: OwnErrors
    remarks: tuple[str, ...]


def train_own_model(bodies: OwnBodies, plan: OwnPlan, packaged: BodyModel) -> OwnModel:
    """Learn a model.

    Parameters
    ----------
    bodies
        From :func:`fitter.training.own_bodies.folder.read_own_bodies`.
    plan
        Axes, held-out subjects and seed.
    packaged
        The packaged model of the same gender, whose pose-dependent term bodies on its surface take
        over when they come without posed scans.

    Raises
    ------
    MeshFolderError
        If too few subjects are left to learn from.
    """
    training, held_out = split_subjects(len(bodies.subjects), plan)
    rest = bodies.rest[training]
    axes, remarks = _possible_axes(rest, bodies, plan)
    posed = with_poses(bodies)
    scans = [scan for scan in posed if scan.subject in training]
    term = _pose_term_source(bodies, training, scans, packaged)
    trained = learn_body_model(
        rest,
        bodies.template.mesh,
        header=_provenance(packaged, bodies, plan, trained_on=len(scans), origin=term.origin),
        shape_count=axes,
        feature_joints=term.feature_joints,
        pose_term=term.make,
    )
    errors = own_errors(trained.model, bodies.rest, held_out, posed)
    header = (
        dict(trained.model.header)
        | model_statistics(trained)
        | {"held_out_errors": header_entry(errors)}
    )
    return OwnModel(
        model=replace(trained.model, header=header),
        errors=errors,
        remarks=remarks,
    )


def split_subjects(
    count: int, plan: OwnPlan
) -> tuple[Integer[np.ndarray, " s"], Integer[np.ndarray, " h"]]:
    """Numbers of the subjects to train on and of those held out, ascending."""
    if not 1 <= plan.held_out <= count - LEAST_SUBJECTS + 1:
        raise MeshFolderError(
            place=f"{REST_FOLDER}/",
            reason=f"holds {count} subjects, of which {plan.held_out} were to be held out",
            remedy=f"Hold out 1 to {count - LEAST_SUBJECTS + 1} with --held-out.",
        )
    order = np.random.default_rng(plan.seed).permutation(count)
    return np.sort(order[plan.held_out :]), np.sort(order[: plan.held_out])


def with_poses(bodies: OwnBodies) -> tuple[PosedScan, ...]:
    """The scans with a pose for each: the one that was given, or the one solved for."""
    mesh = bodies.template.mesh
    areas = vertex_areas(bodies.template.vertices, mesh.triangles)
    return tuple(
        scan
        if scan.pose is not None
        else replace(
            scan, pose=solved_pose(bodies.rest[scan.subject], scan.vertices, mesh.parts, areas)
        )
        for scan in bodies.posed
    )


def _possible_axes(
    rest: Float[np.ndarray, "s m 3"], bodies: OwnBodies, plan: OwnPlan
) -> tuple[int, tuple[str, ...]]:
    """How many axes the bodies span, up to the number wanted; a remark if it is fewer."""
    masses = vertex_masses(rest.mean(axis=0), bodies.template.mesh.triangles)
    aligned = centred(rest, masses)
    flat = (aligned - aligned.mean(axis=0)) * np.sqrt(masses / masses.sum())[:, None]
    flat = flat.reshape(len(rest), -1)
    deviations = np.sqrt(np.maximum(np.linalg.eigvalsh(flat @ flat.T), 0.0) / (len(rest) - 1))
    spanned = int(np.count_nonzero(deviations > LEAST_AXIS_M))
    axes = min(plan.axes, spanned)
    if axes < 2:
        raise MeshFolderError(
            place=f"{REST_FOLDER}/",
            reason=f"holds bodies that differ along {spanned} axes, expected 2 at the very least",
            remedy="Put more people there.",
        )
    if axes == plan.axes:
        return axes, ()
    remark = (
        f"{axes} shape axes instead of {plan.axes}: {len(rest)} bodies to train on span no more"
    )
    return axes, (remark,)


def _pose_term_source(
    bodies: OwnBodies,
    training: Integer[np.ndarray, " s"],
    scans: Sequence[PosedScan],
    packaged: BodyModel,
) -> PoseTermSource:
    mesh = bodies.template.mesh
    if scans:
        return learned_pose_term(
            mesh.parts, len(scans), lambda space: _examples(bodies, training, scans, space)
        )
    if same_surface(mesh, packaged_template(packaged).mesh):
        return packaged_pose_term(packaged)
    return no_pose_term(mesh.parts)


def _examples(
    bodies: OwnBodies,
    training: Integer[np.ndarray, " s"],
    scans: Sequence[PosedScan],
    space: ShapeSpace,
) -> Iterator[PoseExample]:
    place = {int(subject): k for k, subject in enumerate(training)}
    for scan in scans:
        assert scan.pose is not None
        yield PoseExample(
            rest=bodies.rest[scan.subject],
            posed=scan.vertices,
            pose=scan.pose,
            shape=space.coefficients[place[scan.subject]],
        )


def _provenance(
    packaged: BodyModel, bodies: OwnBodies, plan: OwnPlan, *, trained_on: int, origin: str
) -> Mapping[str, object]:
    sources = [f"registered meshes of the user: {bodies.source}"]
    licences = [f"of the registered meshes: {bodies.licence}"]
    if same_surface(bodies.template.mesh, packaged_template(packaged).mesh):
        sources += [f"of the packaged model: {text}" for text in _texts(packaged, "sources")]
        licences += [f"of the packaged model: {text}" for text in _texts(packaged, "licences")]
    return {
        "gender": packaged.gender,
        "units": "metres, radians; body frame: x to the person's left, y up, z forward",
        "sources": sources,
        "licences": licences,
        "topology": bodies.template.name,
        "meshes_sha256": bodies.sha256,
        "seed": plan.seed,
        "training_subjects": len(bodies.subjects) - plan.held_out,
        "held_out_subjects": plan.held_out,
        "pose_examples": trained_on,
        "pose_term": origin,
    }


def _texts(model: BodyModel, key: str) -> list[str]:
    texts = model.header[key]
    return [str(text) for text in texts] if isinstance(texts, list) else [str(texts)]
