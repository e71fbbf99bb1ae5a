"""The figures a build measures and the model's header keeps."""

from fitter.training.assemble import RegisteredBodies, TrainedModel
from fitter.training.body_regions import vertex_regions
from fitter.training.comparison_figures import HEADER_KEY, comparison_figures
from fitter.training.held_out_errors import HeldOutErrors, header_entry
from fitter.training.model_figures import model_figures
from fitter.training.provenance import model_statistics
from fitter.training.shape_curve import error_by_count, error_by_metric


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
    }
