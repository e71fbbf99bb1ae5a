"""The page about the method: names that exist, and figures that stand elsewhere too."""

import pkgutil
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fitter.body.storage import load_body_model, packaged_model_path
from fitter.fits.equipment import PACKAGED, PreparedModel
from fitter.measurement.definitions import load_definitions
from fitter.optimizer.alternation import SMOOTHNESS_SCHEDULE
from fitter.optimizer.light_solve import SPECULAR_EXPONENT
from fitter.vocabulary.choices import Gender

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "service" / "docs" / "method.md").read_text()
TABLES = (ROOT / "service" / "docs" / "accuracy_tables.md").read_text()

NAMES = sorted(set(re.findall(r"`(fitter\.[\w.]+)`", PAGE)))


def test_names_are_found():
    assert len(NAMES) > 50


@pytest.mark.parametrize("name", NAMES)
def test_every_name_can_be_imported(name: str):
    assert pkgutil.resolve_name(name) is not None


def test_the_sizes_of_the_meshes_are_those_of_the_packaged_models():
    women, men = (PACKAGED.model(gender) for gender in (Gender.FEMALE, Gender.MALE))

    def both(count: Callable[[PreparedModel], int]) -> tuple[str, str]:
        return f"{count(women):,}", f"{count(men):,}"

    searched = both(lambda each: len(each.searched.model.mean_vertices))
    shaded = both(lambda each: int(np.count_nonzero(each.searched.shaded.areas)))
    assert f"a simplified mesh of {searched[0]} (women) and {searched[1]} (men)" in on_one_line(
        PAGE
    )
    assert f"sums over {shaded[0]} and {shaded[1]} of these" in on_one_line(PAGE)


def test_the_exponent_and_rounds_are_those_of_the_alternation():
    assert f"alpha$ is {SPECULAR_EXPONENT:.0f} for everybody" in on_one_line(PAGE)
    first, second, last = SMOOTHNESS_SCHEDULE
    assert f"{first:g}, {second:g}, {last:g} over three rounds" in PAGE


def on_one_line(text: str) -> str:
    return " ".join(text.split())


def row(name: str) -> list[str]:
    """What stands in a row of the tables, without the medians in brackets."""
    (found,) = re.findall(rf"^ *\| {re.escape(name)} \|(.*)\|$", TABLES, re.MULTILINE)
    return [each.split()[0] for each in found.split("|")]


def written(name: str) -> list[str]:
    """A row of the page, whole, with its name."""
    (found,) = re.findall(rf"^\| ({re.escape(name)} \|.*) \|$", PAGE, re.MULTILINE)
    return found.split(" | ")


def in_tables(pattern: str) -> str:
    """The one figure in a sentence of the tables."""
    (found,) = re.findall(pattern, on_one_line(TABLES))
    return found


def test_figures_of_the_models_are_those_in_their_files():
    women, men = (load_body_model(packaged_model_path(each)).header for each in ("female", "male"))
    ours: list[dict[str, Any]] = [each["held_out_errors"] for each in (women, men)]
    shape, posed, extent = (
        [f"{each[key]:.1f}" for each in ours]
        for key in ("shape_mm", "posed_mm", "extent_change_at_3_deviations_mm")
    )
    leaked = [
        f"{each['height_in_earlier_methods']['blanz_vetter_height_change_mm']:.1f}"
        for each in (women, men)
    ]
    page = on_one_line(PAGE)
    assert f"bodies, {women['training_subjects']:,} of each gender" in page
    assert (
        f"Shapes of {women['held_out_subjects']} people never trained on are met within {shape[0]} "
        f"mm (women) and {shape[1]} mm (men), poses within {posed[0]} and {posed[1]} mm" in page
    )
    assert f"of the whole mesh by {extent[0]} mm (women) and {extent[1]} mm (men)" in page
    assert f"they leak {leaked[0]} and {leaked[1]} mm" in page
    assert f"The mesh has {women['model_figures']['vertices']:,} vertices" in page
    assert f"first $n = {women['model_figures']['shape_axes']}$ principal axes" in page
    assert f"takes all {len(load_definitions())} measurements" in page
    assert max(each["height_change_at_3_deviations_mm"] for each in ours) < 0.001
    assert f"{shape[0]} mm (women) and {shape[1]} mm (men) for the shapes" in on_one_line(TABLES)
    assert f"{posed[0]} and {posed[1]} mm for poses" in on_one_line(TABLES)


@pytest.mark.parametrize("name", ["SE: silhouette and edges", "SES: and shading"])
def test_the_comparison_with_the_paper_has_the_rows_of_the_tables(name: str):
    chest, waist, _, weight = row(name)[:4]
    assert f"| {name.partition(':')[0]} | {chest} | {waist} | {weight} |" in PAGE


def test_what_shading_gains_by_each_method_is_what_its_rows_say():
    rows = [written(f"the paper's method, {cues}") for cues in ("SE", "SES")]
    outline, shaded = ([float(each.split()[0]) for each in cells[1:]] for cells in rows)
    gained = [round(one - other, 1) for one, other in zip(outline, shaded, strict=True)]
    chest, _, _, weight = gained
    sentence = rf"gains what the paper says it does: {chest} ± [\d.]+ cm of chest and {weight} ± "
    assert re.search(sentence, on_one_line(PAGE))


def test_sentences_have_the_figures_of_the_tables():
    front, both = row("front"), row("front and side")
    waist = row("SES: and shading")[1]
    gained = float(row("SE: silhouette and edges")[1]) - float(waist)
    better = in_tables(r"Shading improves the waist in (\d+ of \d+) pictures")
    wrong = in_tables(r"In (\d+ of \d+) a limb")
    hold = in_tables(r"95 % intervals of SES hold (\d+) %")
    women, men = re.findall(r"([\d.]+) cm \((?:women|men)", on_one_line(TABLES))[:2]
    page = on_one_line(PAGE)
    for sentence in (
        f"waists come nearer to the truth in {better} pictures, by {gained:.1f} cm on the mean",
        f"in {wrong} pictures of the reporting half a limb",
        f"Front and side together err by {', '.join(both[:3])} cm and {both[3]} kg",
        f"the front alone by {', '.join(front[:3])} cm and {front[3]} kg",
        f"{hold} % of the truths lie in the 95 % intervals",
        f"only to {women} cm (women) and {men} cm (men)",
    ):
        assert sentence in page
