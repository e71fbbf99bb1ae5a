"""Fig. 6: deviations from the mean along the axes of the height-preserving shape spaces."""

import numpy as np

from fitter.applications.previews import View, preview
from fitter.body.shape_space import height_of_shape
from fitter.fits.prepared_model import prepared_model
from fitter.reproduction.figure import Figure
from fitter.reproduction.panels import row, stacked
from fitter.vocabulary.choices import Gender

DEVIATIONS = 3.0
_AXES = 4
_HEIGHT_PX = 300


def figure_6() -> Figure:
    """Three standard deviations either way: men above, women below."""
    rows, changes = [], []
    for gender in (Gender.MALE, Gender.FEMALE):
        prepared = prepared_model(gender)
        evaluator = prepared.operators.evaluator
        views: list[View] = []
        titles: list[str] = []
        for axis in range(_AXES):
            heights = []
            for sign in (-1.0, 1.0):
                shape = np.zeros(len(evaluator.model.shape_basis))
                shape[axis] = sign * DEVIATIONS
                heights.append(height_of_shape(evaluator, shape))
                title = "height axis" if axis == 0 else f"axis {axis}"
                titles.append(f"{title}: {sign * DEVIATIONS:+.0f} SD")
                views.append(
                    View(
                        label="",
                        vertices=prepared.measuring.canonical.at(shape),
                        degrees=30.0,
                    )
                )
            if axis:
                changes.append(1000.0 * abs(heights[1] - heights[0]))
        panels = np.split(preview(views, evaluator.model.triangles), len(views), axis=1)
        rows.append(row(list(zip(titles, panels, strict=True)), height_px=_HEIGHT_PX))
    return Figure(
        name="figure_6",
        title="Figure 6: the height-preserving shape spaces",
        caption=(
            "The first pair of each row is three standard deviations either way along the height "
            "axis, the others along the first three axes that keep the height. Men above, women "
            f"below. Along those the stature changes by {max(changes):.3f} mm at most."
        ),
        differs="Learned from synthetic bodies; coefficients are whitened before axes are turned.",
        picture=stacked(rows),
    )
