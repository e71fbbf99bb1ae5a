"""What ``import fitter`` offers, that its examples run, and that we use what DBOS publishes."""

import doctest
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

import fitter
from fitter import library
from service.demo_data.sample import load_sample

REPOSITORY = Path(__file__).parents[2]

NAMES = [
    "BodyEstimate",
    "BodyParameters",
    "Camera",
    "Choices",
    "Click",
    "Clothing",
    "Cues",
    "Equipment",
    "Facing",
    "FitRequest",
    "FitResult",
    "FitStage",
    "FittedPerson",
    "FittedView",
    "FitterError",
    "Gender",
    "InvalidInputError",
    "KnownMeasurement",
    "Light",
    "LightGuess",
    "LightKind",
    "LimbFacing",
    "Measurement",
    "ModelFileError",
    "NumericalError",
    "OptimizerKind",
    "Outcome",
    "Paper",
    "PaperEnergy",
    "Person",
    "PictureFit",
    "Progress",
    "Reflectance",
    "Remark",
    "Stage",
    "StageBody",
    "Verdict",
    "View",
    "ViewKind",
    "body_vertices",
    "estimate_body",
    "files_of",
    "fit",
    "measure",
]
"""Taking one away breaks programs: it is announced in the CHANGELOG a version before."""


def test_the_names_are_those_that_were_promised():
    assert sorted(fitter.__all__) == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_every_name_is_there_and_explains_itself(name):
    found = getattr(fitter, name)
    assert found.__name__ == name
    assert found.__doc__


def test_importing_the_package_loads_no_numerics():
    """A command that needs one part of it does not wait for the others."""
    heavy = "{'numpy', 'numba', 'cv2', 'scipy'}"
    code = f"import sys, fitter; print(sorted({heavy} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.fixture(scope="module")
def sample() -> dict[str, object]:
    """What the examples name: the sample's picture, what was clicked and told, and its fit."""
    files = load_sample()
    asked = json.loads(files.request)
    (view,) = asked["views"]
    clicks = {name: (point["x"], point["y"]) for name, point in view["points"].items()}
    told = {"gender": asked["gender"], "height_m": asked["height_m"]}
    return {"picture": files.image, "clicks": clicks, **told}


@pytest.fixture(scope="module")
def fitted(sample) -> dict[str, object]:
    clicks = {name: fitter.Click(x=x, y=y) for name, (x, y) in sample["clicks"].items()}
    person = fitter.Person(gender=fitter.Gender(sample["gender"]), height_m=sample["height_m"])
    view = fitter.View(image=sample["picture"], clicks=clicks)
    return {**sample, "result": fitter.fit(fitter.FitRequest(person=person, views=(view,)))}


@pytest.mark.slow
def test_examples_run(fitted):
    failed, tried = doctest.testmod(library, extraglobs=fitted)
    assert tried > 0
    assert failed == 0


PRIVATE = re.compile(
    r"from dbos(\.\w+)* import .*\b_|(from|import) dbos\._|\b(DBOS|client|dbos)\._[a-z]"
    r"|\b(FROM|INTO|UPDATE) (dbos\.|workflow_status|operation_outputs)"
)
"""Modules and names that begin with an underscore, and its tables in a statement."""


def test_nothing_uses_what_is_not_published():
    sources = [*(REPOSITORY / "service").rglob("*.py"), *(REPOSITORY / "tests").rglob("*.py")]
    assert [
        f"{path.relative_to(REPOSITORY)}: {found[0]}"
        for path in sources
        if path != Path(__file__)
        for found in PRIVATE.finditer(path.read_text())
    ] == []


@pytest.mark.parametrize(
    "source",
    [
        "from dbos._sys_db import SystemDatabase",
        "from dbos import DBOS, _queue",
        "import dbos._queue",
        "DBOS._recover_pending_workflows([])",
        "SELECT status FROM dbos.workflow_status",
    ],
)
def test_a_private_use_is_found(source: str):
    assert PRIVATE.search(source)
