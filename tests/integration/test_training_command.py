import importlib.util
from pathlib import Path

import pytest

from fitter.body.storage import load_body_model
from fitter.training.__main__ import main

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(importlib.util.find_spec("anny") is None, reason="needs maquette[training]"),
]

SMALL = ["--gender", "female", "--subjects", "24", "--held-out", "2", "--examples", "12"]


def run(output: Path, cache: Path, command: str = "build") -> int:
    return main([command, *SMALL, "--output", str(output), "--cache", str(cache)])


def test_building_twice_gives_the_same_bytes_and_a_report(tmp_path, capsys):
    cache = tmp_path / "cache"
    for folder in ("first", "second"):
        assert run(tmp_path / folder, cache) == 0
    first, second = (tmp_path / folder / "female.npz" for folder in ("first", "second"))
    assert first.read_bytes() == second.read_bytes()
    model = load_body_model(first)
    assert model.header["training_subjects"] == 24
    assert 1.5 < model.header["height_m"]["mean"] < 1.75
    capsys.readouterr()
    assert run(tmp_path / "first", cache, "report") == 0
    printed = capsys.readouterr().out
    for words in ("mean vertex error, n = 20", "posed error, rigid parts only", "stature"):
        assert words in printed
