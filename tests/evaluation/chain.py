"""Where a fit's errors come from: from our body on the true mesh to a fit that is told nothing.

What the shape space cannot say remains on the mesh; each rung after that takes one truth away.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from fitter.body.model import regress
from fitter.fits.prepared_model import prepared_model
from fitter.measurement.anthropometry import measure
from fitter.measurement.taking import CENTIMETRES_PER_METRE
from fitter.result import before_shading
from fitter.vocabulary.choices import Cues
from fitter.vocabulary.measurements import STATURE
from tests.evaluation.foreign import foreign_mesh, foreign_picture
from tests.evaluation.joint_figures import distance_errors_m, joint_error_mm
from tests.evaluation.mesh_fit import MeshFit, fit_mesh
from tests.evaluation.runs import held_on
from tests.evaluation.scoring import fit_picture, score
from tests.evaluation.true_picture import Told, TruePicture
from tests.evaluation.trunk_sections import TrunkSections, trunk_sections

COEFFICIENTS = (10, 20, 40, 80)
"""Of the shape, as many as a model has: how much more of them would say."""

RUNGS: Mapping[str, Told] = {
    "mask, pose, place": Told(mask=True, focal_length=True, pose=True, place=True),
    "mask, pose": Told(mask=True, focal_length=True, pose=True),
    "pose": Told(pose=True),
    "mask": Told(mask=True),
    "nothing": Told(),
}
"""What fits are told; the first two the focal length too, without which a place means nothing."""


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Link:
    """A picture on one rung; errors are found minus true.

    ``joint_mm`` is as in :class:`~tests.evaluation.scoring.Scored`, ``hips_m`` of the hips'
    distance from the camera, None where the fit knows no focal length; what they are on the mesh
    tells how differently joints are defined. There ``cues`` are None, in pictures ``stature_cm``,
    which is given, and ``trunk_mm``, the mesh's distance from our trunk.
    """

    picture: str
    rung: str
    cues: Cues | None
    errors: Mapping[str, float]
    trunk: TrunkSections
    joint_mm: float
    hips_m: float | None
    stature_cm: float | None
    trunk_mm: float | None


def chain_of(name: str) -> list[Link]:
    """All rungs of a foreign picture: of each fit, its body before shading and after."""
    picture, mesh = foreign_picture(name), foreign_mesh(name)
    available = len(prepared_model(mesh.gender).operators.model.shape_basis)
    counts = sorted({min(count, available) for count in COEFFICIENTS})
    on_mesh = {count: fit_mesh(mesh, coefficients=count) for count in counts}
    return [
        *(_on_mesh(picture, count, fitted) for count, fitted in on_mesh.items()),
        *_in_picture(picture, on_mesh[counts[-1]]),
    ]


def mesh_rung(count: int) -> str:
    """The name of a rung on the mesh."""
    return f"mesh, {count} coefficients"


def _on_mesh(picture: TruePicture, count: int, fitted: MeshFit) -> Link:
    prepared, truth = prepared_model(picture.request.person.gender), picture.truth
    shape = fitted.parameters.shape
    found = {each.name: each.value for each in measure(prepared.measuring, shape)}
    model = prepared.operators.model
    joints = regress(model.joint_regressor, fitted.vertices)
    ours = trunk_sections(prepared.measuring.canonical.at(shape), model.triangles)
    return Link(
        picture=picture.name,
        rung=mesh_rung(count),
        cues=None,
        errors={name: found[name] - value for name, value in truth.measurements.items()},
        trunk=ours - trunk_sections(truth.canonical, truth.triangles),
        joint_mm=joint_error_mm(joints, picture.joints),
        hips_m=distance_errors_m(joints, picture.joints)["hips"],
        stature_cm=found[STATURE] - CENTIMETRES_PER_METRE * truth.stature_m,
        trunk_mm=fitted.trunk_mm,
    )


def _in_picture(picture: TruePicture, on_mesh: MeshFit) -> Iterator[Link]:
    for rung, told in RUNGS.items():
        held = replace(held_on(on_mesh), place_held=told.place) if told.pose else None
        shaded = fit_picture(picture, Cues.SES, told, held=held)
        before = before_shading(shaded.result)
        fits = [shaded]
        if before is not None:
            fits.insert(0, replace(shaded, cues=Cues.SE, result=before))
        for scored in map(score, fits):
            yield Link(
                picture=picture.name,
                rung=rung,
                cues=scored.cues,
                errors=scored.errors,
                trunk=scored.trunk,
                joint_mm=scored.joint_mm,
                hips_m=scored.distances_m["hips"] if scored.focal_length_known else None,
                stature_cm=None,
                trunk_mm=None,
            )
