import functools
from pathlib import Path
from types import ModuleType

import pytest

from fitter.body.storage import load_body_model
from fitter.training import __main__ as command_line
from fitter.training import build
from fitter.training.__main__ import main
from fitter.training.articulation import inner_points
from fitter.training.report import (
    articulation_figures,
    civilian_figures,
    held_out_errors,
    measured_people,
    raised_arm_figures,
    refinement_effect,
    repeatability_figures,
    sections,
    summary_figures,
)
from fitter.training.report.provenance import residual_lines
from fitter.training.report.summary_figures import summary_lines
from tests.unit.training.makehuman_data import needs_makehuman

pytestmark = [pytest.mark.slow, needs_makehuman]

SMALL = ["--gender", "female", "--subjects", "24", "--held-out", "2", "--examples", "12"]


@pytest.fixture(autouse=True)
def _few_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every stage and section is there, of fewer random people and poses than make good figures.

    What is read of MakeHuman's data is read once.
    """

    def fewer(module: ModuleType, function: str, **count: int) -> None:
        monkeypatch.setattr(module, function, functools.partial(getattr(module, function), **count))

    read = functools.cache(command_line.read_materials)
    monkeypatch.setattr(command_line, "read_materials", read)
    monkeypatch.setattr(inner_points, "EXAMPLES", 60)
    fewer(build, "with_volume_learned", samples=40)
    monkeypatch.setattr(held_out_errors, "POSED_EXAMPLES", 8)
    monkeypatch.setattr(measured_people, "PEOPLE", 30)
    monkeypatch.setattr(articulation_figures, "POSES", 20)
    monkeypatch.setattr(articulation_figures, "COMPARED", 6)
    monkeypatch.setattr(raised_arm_figures, "POSES", 4)
    monkeypatch.setattr(refinement_effect, "RANDOM_BODIES", 1)
    fewer(repeatability_figures, "repeatability_figures", bodies=3)
    fewer(civilian_figures, "figures_of_civilians", count=500)
    monkeypatch.setattr(summary_figures, "TIMED_EVALUATIONS", 20)


def run(output: Path, cache: Path, command: str = "build", *more: str) -> int:
    return main([command, *SMALL, "--output", str(output), "--cache", str(cache), *more])


def test_a_model_is_built_and_reported_on_again_from_its_file(tmp_path, capsys, monkeypatch):
    cache = tmp_path / "cache"
    with monkeypatch.context() as first:
        # What is compared below; all sections are made of the model as its file has it.
        first.setattr(sections, "SECTIONS", (summary_lines, residual_lines))
        assert run(tmp_path, cache) == 0
    built = capsys.readouterr().out
    model = load_body_model(tmp_path / "female.npz")
    assert model.header["training_subjects"] == 24
    assert 1.5 < model.header["height_m"]["mean"] < 1.75
    pictures = tmp_path / "pictures"
    assert run(tmp_path, cache, "report", "--pictures", str(pictures)) == 0
    assert len(list(pictures.glob("female_*.png"))) == 5
    again = capsys.readouterr().out.splitlines()
    for name in ("mean vertex error, n = 20", "posed error, rigid parts only", "weightkg"):
        (line,) = (line for line in again if line.strip().startswith(name))
        assert line in built
