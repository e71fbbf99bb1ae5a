import functools

import pytest

from fitter.body.storage import load_body_model
from fitter.training import build
from fitter.training.__main__ import main
from fitter.training.articulation import bone_centres as inner_points
from fitter.training.report import held_out_figures, sections
from tests.unit.training.makehuman_data import needs_makehuman

pytestmark = [pytest.mark.slow, needs_makehuman]


@pytest.fixture(autouse=True)
def _few_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every stage and section is there, of fewer random people and poses than make good figures."""
    monkeypatch.setattr(inner_points, "EXAMPLES", 60)
    few = functools.partial(build.with_volume_learned, samples=40)
    monkeypatch.setattr(build, "with_volume_learned", few)
    monkeypatch.setattr(held_out_figures, "POSED_EXAMPLES", 8)
    few = functools.partial(sections.drawn_measurements, count=200)
    monkeypatch.setattr(sections, "drawn_measurements", few)


def test_a_model_is_built_and_reported_on_from_its_file(tmp_path, capsys):
    counts = ["--subjects", "24", "--held-out", "2", "--examples", "12"]
    told = ["--unexplained", str(tmp_path / "unexplained.json")]
    assert main(["build", "--gender", "female", *counts, "--output", str(tmp_path), *told]) == 0
    model = load_body_model(tmp_path / "female.npz")
    assert model.header["training_subjects"] == 24
    assert 1.5 < model.header["height_m"]["mean"] < 1.75
    printed = capsys.readouterr().out
    assert "the header's held-out figures, made again: the same" in printed
    assert "weightkg" in printed
    assert model.checksum in (tmp_path / "unexplained.json").read_text()
