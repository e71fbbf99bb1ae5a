"""What every section of the report is made from."""

from dataclasses import dataclass

from fitter.body.model import BodyModel
from fitter.training.articulation.registered_bodies import RegisteredBodies
from fitter.training.report.held_out_errors import HeldOutErrors


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Reported:
    """A trained model, and bodies it has not seen.

    Attributes
    ----------
    model
        As its file has it, with its header.
    bodies
        The held-out subjects.
    errors
        The model's errors on them.
    file_bytes
        Size of the model file.
    """

    model: BodyModel
    bodies: RegisteredBodies
    errors: HeldOutErrors
    file_bytes: int
