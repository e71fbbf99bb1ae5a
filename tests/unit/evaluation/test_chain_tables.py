from dataclasses import replace

import numpy as np

from fitter.vocabulary.choices import Cues
from tests.evaluation.chain import Link
from tests.evaluation.chain_tables import chain_case_lines, chain_lines
from tests.evaluation.table import MEASUREMENTS
from tests.evaluation.trunk_sections import LEVELS, TrunkSections


def _link(picture: str, rung: str, cues: Cues | None, error: float) -> Link:
    extents = np.full(len(LEVELS), error / 100.0)
    return Link(
        picture=picture,
        rung=rung,
        cues=cues,
        errors={key: error for _, key, _ in MEASUREMENTS},
        trunk=TrunkSections(breadth_m=extents, depth_m=-extents),
        joint_mm=30.0,
        hips_m=error / 100.0,
        stature_cm=None if cues else -1.5,
        trunk_mm=6.0 if cues is None else None,
    )


LINKS = [
    _link(picture, rung, cues, error)
    for picture, sign in (("first", 1.0), ("second", -2.0))
    for rung, cues, error in (
        ("mesh", None, sign), ("mask", Cues.SE, 2.0 * sign), ("mask", Cues.SES, 3.0 * sign),
    )
]  # fmt: skip


def test_every_rung_sums_up_its_pictures():
    girths = {tuple(line.split()[:2]): line.split()[2:] for line in chain_lines(LINKS)[2:5]}
    assert girths["mesh", "-"][:2] == ["1.50", "(-0.50)"]
    assert girths["mask", "SES"][:2] == ["4.50", "(-1.50)"]
    assert [line[-1] for line in girths.values()] == ["6.0", "-", "-"]


def test_breadths_and_depths_keep_their_own_signs():
    lines = chain_lines(LINKS)
    breadth = next(n for n, line in enumerate(lines) if line.startswith("breadth"))
    depth = next(n for n, line in enumerate(lines) if line.startswith("depth"))
    assert lines[breadth + 1].count("1.50 (-0.50)") == len(LEVELS)
    assert lines[depth + 1].count("1.50 (+0.50)") == len(LEVELS)


def test_pictures_show_the_mesh_and_ses():
    _, *lines = chain_case_lines(LINKS)
    assert [line.split()[:2] for line in lines] == [
        ["first", "mesh"], ["first", "mask"], ["second", "mesh"], ["second", "mask"],
    ]  # fmt: skip
    assert lines[1].count("+3.0") == len(MEASUREMENTS) + 2
    assert lines[1].count("-3.0") == 1


def test_distances_are_of_pictures_whose_focal_length_is_known():
    known, unknown = LINKS[2], replace(LINKS[5], hips_m=None)
    assert "3.00 (+3.00)" in chain_lines([known, unknown])[2]
    assert chain_lines([unknown])[2].split()[-4:] == ["-", "-", "30.0", "-"]
    assert chain_case_lines([unknown])[1].split()[-4:] == ["-", "-", "30.0", "-"]
