"""The figures a build measures and the model's header keeps."""

import numpy as np
from jaxtyping import Float

from fitter.body.model import BodyModel
from fitter.measurement.definition_file import load_definitions
from fitter.measurement.unexplained import UNEXPLAINED_KEY
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.assemble import TrainedModel
from fitter.training.report.body_regions import vertex_regions
from fitter.training.report.comparison_figures import HEADER_KEY, comparison_figures
from fitter.training.report.evaluation import shape_residuals
from fitter.training.report.held_out_errors import HeldOutErrors, header_entry
from fitter.training.report.measured_people import measured_bodies
from fitter.training.report.model_figures import model_figures
from fitter.training.report.provenance import model_statistics
from fitter.training.report.shape_curve import error_by_count, error_by_metric


def header_figures(
    trained: TrainedModel,
    taught: RegisteredBodies,
    held_out: RegisteredBodies,
    errors: HeldOutErrors,
) -> dict[str, object]:
    """Everything measured on a trained model, its training and its held-out subjects."""
    model = trained.model
    regions = vertex_regions(model)
    return model_statistics(trained) | {
        "model_figures": model_figures(model),
        "held_out_errors": header_entry(errors),
        "shape_error_by_count": error_by_count(
            taught.rest, held_out.rest, model.triangles, taught.measurements
        ),
        "shape_error_by_metric": error_by_metric(
            taught.rest, held_out.rest, model.triangles, regions, taught.measurements
        ),
        HEADER_KEY: comparison_figures(trained, held_out.rest),
        UNEXPLAINED_KEY: unexplained_measurements(model, held_out.rest),
    }


def unexplained_measurements(
    model: BodyModel, rest: Float[np.ndarray, "s m 3"]
) -> dict[str, float]:
    """Root mean square by which held-out bodies measure other than when rebuilt from n."""
    true = measured_bodies(model, rest)
    rebuilt = measured_bodies(model, rest - shape_residuals(model, rest))
    spread = np.sqrt(np.mean((rebuilt - true) ** 2, axis=0))
    return {
        definition.about.name: round(float(value), 4)
        for definition, value in zip(load_definitions(), spread, strict=True)
    }
