"""The page about bad pictures: every code of the code and no other, with its threshold."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from api_schemas import questions as wire
from fitter.capture import framing, people, picture_quality, posture
from fitter.fits import reporting
from fitter.fits.error_widening import HARM
from fitter.observation import decoding
from fitter.person.several_pictures import SAME_PERSON_PROBABILITY
from fitter.vocabulary.remarks import Code, Note

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "service" / "docs" / "pictures.md").read_text()


def rows(heading: str) -> dict[str, str]:
    """The table's rows below a heading, by the codes in their first cell."""
    (part,) = re.findall(rf"^## {heading}$(.*?)(?=^## |\Z)", PAGE, re.MULTILINE | re.DOTALL)
    found: dict[str, str] = {}
    for line in re.findall(r"^\| (`.*)$", part, re.MULTILINE):
        first, rest = line.split(" | ", 1)
        for code in re.findall(r"`([a-z-]+)`", first):
            assert code not in found
            found[code] = rest
    return found


BY_FITS_ALONE = {"covered", "squeezed", "contradicted"}
CHECKS = rows("Findings")
HARMS = rows("What harms")
OF_FITS = rows("Warnings of a fit")
OF_POINTS = rows("Warnings of proposed points")
OF_PRODUCTS = rows("Warnings of products")
REFUSALS = rows("Refusals of pictures")


def sources(*folders: str) -> Iterator[Path]:
    for folder in folders:
        yield from (ROOT / folder).rglob("*.py")


def codes_of(call: str, files: Iterator[Path]) -> set[str]:
    """Constant codes with which a type is called."""
    found: set[str] = set()
    for file in files:
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Call) and getattr(node.func, "id", None) == call:
                for word in node.keywords:
                    if word.arg == "code" and isinstance(word.value, ast.Constant):
                        found.add(str(word.value.value))
    return found


def test_the_checks_are_those_of_the_code_in_its_order():
    assert sorted(CHECKS) == sorted(code.value for code in Code)
    assert [code for code in CHECKS if code not in BY_FITS_ALONE] == [
        code.value for code in Code if code.value not in BY_FITS_ALONE
    ]


def test_what_harms_widens_errors_as_the_code_does():
    assert set(HARMS) == {code.value for code in HARM}
    for code, harm in HARM.items():
        factors = [float(each) for each in HARMS[code].strip(" |").split(" | ")]
        assert factors == [harm.chest, harm.waist, harm.hip, harm.weight], code


def test_they_are_those_of_the_wire():
    described = re.findall(r"``([a-z-]+)``", (wire.PointsProposal.__doc__ or "").split("Codes:")[1])
    assert set(CHECKS) - BY_FITS_ALONE <= set(described)


@pytest.mark.parametrize(
    ("code", "thresholds"),
    [
        (Code.PERSON_TOO_SMALL, (framing.LEAST_STATURE_PX, framing.BLOCKING_STATURE_PX)),
        (Code.PICTURE_TOO_SMALL, (framing.LEAST_STATURE_PX, framing.BLOCKING_STATURE_PX)),
        (Code.OTHER_VIEW, (posture.LEAST_FRONTAL, posture.CLEARLY_TURNED)),
        (Code.ARMS_AGAINST_TRUNK, (posture.LEAST_FREE,)),
        (
            Code.NOT_STANDING,
            (
                posture.BENT_DEG,
                posture.FOLDED_DEG,
                posture.CROUCHED_DEG,
                posture.SEATED_DEG,
                posture.KNEELING_DEG,
                posture.LYING_DEG,
                posture.STOOPED_DEG,
                posture.LOW_HEAD,
                posture.HANGING_HEAD,
            ),
        ),
        (Code.CHILD, (people.MOST_BETWEEN_EYES,)),
        (Code.BLURRED, (picture_quality.HARMFUL_PX, picture_quality.BLOCKING_PX)),
        (Code.TOO_DARK, (picture_quality.DARKEST,)),
        (Code.TOO_BRIGHT, (picture_quality.BURNT, picture_quality.MOST_BURNT)),
        (Code.CAMERA_ROLLED, (framing.MOST_ROLLED_DEG,)),
        (Code.CAMERA_TOO_NEAR, (framing.NEAREST_M,)),
        (Code.CUT_OFF, (framing.BORDER_PX,)),
        (Code.SEVERAL_PEOPLE, (people.MUDDLED_SHARE,)),
    ],
)
def test_thresholds_are_those_of_the_code(code: Code, thresholds: tuple[float, ...]):
    numbers = [float(each) for each in re.findall(r"\d+(?:\.\d+)?", CHECKS[code])]
    assert set(thresholds) <= set(numbers)


def test_a_check_that_may_block_says_when():
    """By the severities that the modules of ``fitter.capture`` name."""
    blocking = {code for code, row in CHECKS.items() if "blocks" in row}
    assert blocking == {
        code.value
        for code in (
            Code.NOBODY_FOUND,
            Code.SEVERAL_PEOPLE,
            Code.CUT_OFF,
            Code.PERSON_TOO_SMALL,
            Code.PICTURE_TOO_SMALL,
            Code.OTHER_VIEW,
            Code.BLURRED,
            Code.NOT_STANDING,
            Code.CHILD,
            Code.CONTRADICTED,
        )
    }
    modules = {"people": 4, "framing": 2, "picture_quality": 1, "posture": 3}
    for file in sources("fitter/capture"):
        named = file.read_text().count("Severity.BLOCKS")
        if file.stem not in ("checking",):
            assert named == modules.get(file.stem, 0), file.name


def test_warnings_are_those_of_the_catalogue():
    of_no_warning = {"height-assumed", "lens-assumed", "points-proposed"}
    told = {*OF_FITS, *OF_POINTS, *OF_PRODUCTS}
    assert told == {each.value for each in Note} - of_no_warning | {"other-view"}


def test_the_figures_of_warnings_are_those_of_the_code():
    assert f"less than {reporting.POOR_OVERLAP} " in OF_FITS["low-silhouette-overlap"]
    assert f"within {reporting.AMBIGUOUS_NATS:g} nats" in OF_FITS["ambiguous-limb-facing"]
    assert f"{reporting.MOST_TURNED_DEG:g} degrees" in OF_FITS["other-view"]
    assert f"{reporting.MOST_DEVIATIONS:g} standard errors" in OF_FITS["given-contradicted"]
    assert f"{SAME_PERSON_PROBABILITY:.0%}".replace("%", " %") in OF_FITS["different-people"]
    assert f"{decoding.LEAST_SIDE_PX} pixels" in REFUSALS["image-too-small"]
    assert f"{decoding.LARGEST_ASPECT_RATIO:g} times" in REFUSALS["image-too-narrow"]


def test_pictures_and_masks_are_refused_by_no_other_code():
    decoding_text = (ROOT / "fitter" / "observation" / "decoding.py").read_text()
    made = {f"image-{word}" for word in re.findall(r'f"\{field\}-([a-z-]+)"', decoding_text)}
    made |= codes_of(
        "InvalidInputError", iter([ROOT / "fitter" / "observation" / "observation.py"])
    )
    made |= codes_of("FieldProblem", iter([ROOT / "service" / "submissions" / "submission.py"]))
    made |= codes_of("InvalidInputError", sources("fitter/segmentation", "fitter/pose_init"))
    assert made - set(REFUSALS) == set()
    everything = "\n".join(file.read_text() for file in sources("fitter", "service", "api_schemas"))
    for code in REFUSALS:
        word = code.removeprefix("image-")
        assert f'"{code}"' in everything or f'f"{{field}}-{word}"' in decoding_text, code
