"""How well a fit's light and reflectance explain its picture, and how even they leave the skin."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from fitter.body.model import BodyModel
from fitter.energies.shading import seen_vertices
from fitter.evidence.intensity import intensity_map
from fitter.fits.prepared_model import prepared_model
from fitter.observation.colour import linear_from_display, luminance_of
from fitter.render.rasterizer import render
from fitter.render.reflectance import shade
from fitter.render.shadow import cast_shadow, lamp_seen
from fitter.result import FitResult
from fitter.vocabulary.choices import Cues, SurroundingsKind
from tests.evaluation.scene import Case
from tests.evaluation.scoring import Scored, fit_picture, score
from tests.evaluation.suite import case_picture
from tests.evaluation.table import INTERVALS, MEASUREMENTS, held
from tests.evaluation.true_picture import Told

BARE_PARTS = ("forearm", "upper_arm", "shin")
"""What these parts' names hold: nobody in the suite wears anything there."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LightFigures:
    """Of one fit; NaN where nothing of the kind is to be seen.

    Attributes
    ----------
    unexplained, unexplained_in_shadow
        Mean absolute difference of shown and predicted brightness over the median brightness, of
        all that is seen, and of what the lamp found casts a shadow on.
    skin_lit, skin_in_shadow, skin_hidden
        Root mean square of log albedo on bare arms and shins about its mean where they are lit: the
        suite's skins have one colour, with 5 % of blotches.
    """

    unexplained: float
    unexplained_in_shadow: float
    skin_lit: float
    skin_in_shadow: float
    skin_hidden: float


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class InLight:
    """A picture fitted with one description of the surroundings."""

    surroundings: SurroundingsKind
    scored: Scored
    figures: LightFigures


def in_both_lights(cases: Sequence[Case]) -> Iterator[InLight]:
    """Each picture with uniform ambient light and with spherical harmonics."""
    for picture in map(case_picture, cases):
        for kind in SurroundingsKind:
            fitted = fit_picture(picture, Cues.SES, Told(surroundings=kind))
            yield InLight(
                surroundings=kind, scored=score(fitted), figures=light_figures(fitted.result)
            )


def light_figures(result: FitResult) -> LightFigures:
    """Compare a result with the picture it was fitted to."""
    light, reflectance = result.person.light, result.person.reflectance
    assert light is not None
    assert reflectance is not None
    operators = prepared_model(result.person.gender).operators
    model, areas = operators.model, operators.shaded.areas
    display = result.views[0].pictures.image
    intensity = intensity_map(
        luminance_of(linear_from_display(display)), display, result.views[0].pictures.segmentation
    )
    vertices = result.found.posed_vertices
    rendering = render(vertices, model.triangles, result.views[0].camera)
    centre = result.person.body.translation
    shadow = cast_shadow(vertices, model.triangles, light=light, body_centre=centre)
    predicted = shade(
        vertices,
        rendering.vertex_normals,
        light=light,
        body_centre=centre,
        reflectance=reflectance,
        lit=lamp_seen(vertices, model.triangles, light=light, body_centre=centre),
    )
    counted = areas > 0.0
    seen = seen_vertices(rendering, intensity) & counted
    observed = intensity.at(rendering.projected)
    missed = np.abs(predicted - observed) / float(np.median(observed[seen]))
    bare = _bare(model) & counted
    logarithm = np.log(np.maximum(reflectance.albedo, 1e-3))

    def mean(values: Float[np.ndarray, " m"], chosen: Bool[np.ndarray, " m"]) -> float:
        return float(np.average(values[chosen], weights=areas[chosen])) if chosen.any() else np.nan

    uneven = (logarithm - mean(logarithm, bare & seen & ~shadow)) ** 2
    return LightFigures(
        unexplained=mean(missed, seen),
        unexplained_in_shadow=mean(missed, seen & shadow),
        skin_lit=mean(uneven, bare & seen & ~shadow) ** 0.5,
        skin_in_shadow=mean(uneven, bare & seen & shadow) ** 0.5,
        skin_hidden=mean(uneven, bare & ~seen) ** 0.5,
    )


def _bare(model: BodyModel) -> Bool[np.ndarray, " m"]:
    bare = np.zeros(len(model.mean_vertices), dtype=np.bool_)
    for part, name in enumerate(model.part_names):
        if any(word in name for word in BARE_PARTS):
            bare[model.triangles[model.part_of_triangle == part]] = True
    return bare


def light_lines(found: Sequence[InLight]) -> list[str]:
    """Mean errors with each description of the surroundings, side by side."""
    of = {kind: [each for each in found if each.surroundings is kind] for kind in SurroundingsKind}
    rows = {
        f"{name} [{unit}]": [abs(each.scored.errors[key]) for each in found]
        for name, key, unit in MEASUREMENTS
    }
    rows["vertices [mm]"] = [each.scored.vertex_mm or np.nan for each in found]
    rows["light [degrees]"] = [each.scored.light_degrees or 0.0 for each in found]
    for name in LightFigures.__slots__:
        rows[f"{name.replace('_', ' ')} [%]"] = [
            100.0 * getattr(each.figures, name) for each in found
        ]
    rows["seconds"] = [each.scored.seconds for each in found]
    lines = [f"{'':26s}" + "".join(f"{f'{kind} mean':>26s}{'median':>8s}" for kind in of)]
    for name, values in rows.items():
        line = f"{name:26s}"
        for kind in of:
            mine = [v for v, each in zip(values, found, strict=True) if each.surroundings is kind]
            line += f"{np.nanmean(mine):26.2f}{np.nanmedian(mine):8.2f}"
        lines.append(line)
    level, deviations = INTERVALS[-1]
    line = f"{f'truth in {level} %':26s}"
    for these in of.values():
        keys = [key for _, key, _ in MEASUREMENTS]
        yes = [inside for each in these for inside in held(each.scored, keys, deviations)]
        line += f"{f'{sum(yes)}/{len(yes)}':>26s}{'':8s}"
    return [*lines, line.rstrip()]
