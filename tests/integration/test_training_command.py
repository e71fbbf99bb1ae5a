from pathlib import Path

import pytest

from fitter.body.storage import load_body_model
from fitter.training.__main__ import main
from tests.unit.training.makehuman_data import needs_makehuman

pytestmark = [pytest.mark.slow, needs_makehuman]

SMALL = ["--gender", "female", "--subjects", "24", "--held-out", "2", "--examples", "12"]


def run(output: Path, cache: Path, command: str = "build", *more: str) -> int:
    return main([command, *SMALL, "--output", str(output), "--cache", str(cache), *more])


def test_a_model_is_built_and_reported_on_again_from_its_file(tmp_path, capsys):
    cache = tmp_path / "cache"
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
