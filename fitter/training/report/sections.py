"""The report on a trained model: its sections, in order."""

from collections.abc import Callable, Iterator

from fitter.training.report.articulation_figures import articulation_lines
from fitter.training.report.attribute_figures import attribute_lines
from fitter.training.report.civilian_figures import civilian_lines
from fitter.training.report.comparison_figures import comparison_lines
from fitter.training.report.header_agreement import agreement_lines
from fitter.training.report.limb_length_figures import limb_length_lines
from fitter.training.report.measurement_figures import measurement_lines
from fitter.training.report.mesh_balance import mesh_balance_lines
from fitter.training.report.provenance import residual_lines
from fitter.training.report.raised_arm_figures import raised_arm_lines
from fitter.training.report.repeatability_figures import repeatability_lines
from fitter.training.report.reported import Reported
from fitter.training.report.shape_figures import shape_lines
from fitter.training.report.summary_figures import summary_lines

Section = Callable[[Reported], tuple[str, ...]]

SECTIONS: tuple[Section, ...] = (
    summary_lines,
    agreement_lines,
    shape_lines,
    articulation_lines,
    raised_arm_lines,
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
