"""What errs without a picture: the most probable body of what is known, of the same people.

A table of errors means little without these rows: people resemble each other.
"""

from collections.abc import Mapping, Sequence

from fitter.fits.equipment import PACKAGED
from fitter.population.body_estimate import estimate_body
from fitter.request import KnownMeasurement
from fitter.vocabulary.measurements import STATURE, WEIGHT
from tests.accuracy.clothing_table import null_heading, null_lines
from tests.accuracy.runs import picture_of
from tests.accuracy.table import MEASUREMENTS
from tests.accuracy.true_picture import TruePicture

NULLS: Mapping[str, tuple[str, ...]] = {
    "null: gender": (),
    "null: height": (STATURE,),
    "null: height, weight": (STATURE, WEIGHT),
}
"""What is known where no picture is looked at."""


def null_errors(picture: TruePicture, known: Sequence[str]) -> dict[str, float]:
    """Errors of the most probable body, without a picture; centimetres and kilograms."""
    person, truth = picture.request.person, picture.truth
    assert person.height_m is not None
    true = {STATURE: 100.0 * person.height_m, **truth.measurements}
    told = {name: KnownMeasurement(value=true[name]) for name in known}
    found = {
        each.name: each.value
        for each in estimate_body(PACKAGED.model(person.gender).population, told).measurements
    }
    return {key: found[key] - truth.measurements[key] for _, key, _ in MEASUREMENTS}


def null_rows(names: Sequence[str]) -> list[str]:
    """Of the people in pictures by name, each once."""
    people = {(each := picture_of(name)).person: each for name in reversed(names)}
    return null_lines(
        {
            title: [null_errors(picture, known) for picture in reversed(people.values())]
            for title, known in NULLS.items()
        }
    )


def null_table(names: Sequence[str]) -> list[str]:
    """The same with a heading, where the table above has other columns."""
    return null_heading() + null_rows(names)
