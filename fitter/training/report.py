"""The report on a trained model: its sections, in order."""

from collections.abc import Callable, Iterator

from fitter.training.articulation_figures import articulation_lines
from fitter.training.attribute_figures import attribute_lines
from fitter.training.civilian_figures import civilian_lines
from fitter.training.comparison_figures import comparison_lines
from fitter.training.header_agreement import agreement_lines
from fitter.training.limb_length_figures import limb_length_lines
from fitter.training.measurement_figures import measurement_lines
from fitter.training.mesh_balance import mesh_balance_lines
from fitter.training.provenance import residual_lines
from fitter.training.repeatability_figures import repeatability_lines
from fitter.training.reported import Reported
from fitter.training.shape_figures import shape_lines
from fitter.training.summary_figures import summary_lines

Section = Callable[[Reported], tuple[str, ...]]

SECTIONS: tuple[Section, ...] = (
    summary_lines,
    agreement_lines,
    shape_lines,
    articulation_lines,
    attribute_lines,
    comparison_lines,
    limb_length_lines,
    civilian_lines,
    measurement_lines,
    repeatability_lines,
    mesh_balance_lines,
    residual_lines,
)


def report_lines(reported: Reported) -> Iterator[str]:
    """The report line by line, every section as soon as it is made."""
    for section in SECTIONS:
        yield from section(reported)
