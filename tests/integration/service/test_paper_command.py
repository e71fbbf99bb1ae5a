"""``maquette paper``: every figure and the table, from real fits."""

import io
import json

import pytest
from PIL import Image

from service.cli import main
from service.demo_data.sample import FOLDER

FIGURES = ("2", "3", "4", "5", "6", "7", "8", "8_ours", "9", "10")


def test_every_figure_and_the_table_are_drawn(tmp_path):
    (tmp_path / "painting.jpg").write_bytes((FOLDER / "woman.jpg").read_bytes())
    (tmp_path / "painting.json").write_bytes((FOLDER / "woman.json").read_bytes())
    out = tmp_path / "out"
    painting = ["--painting", str(tmp_path / "painting.jpg"), str(tmp_path / "painting.json")]
    with pytest.raises(SystemExit) as ended:
        main(["paper", "--output", str(out), *painting])
    assert ended.value.code == 0
    page = (out / "index.md").read_text()
    for number in FIGURES:
        picture = Image.open(io.BytesIO((out / f"figure_{number}.png").read_bytes()))
        assert picture.width > 600
        assert f"(figure_{number}.png)" in page
    assert page.count("*Different:*") == len(FIGURES)
    assert page.count("**Table 1 ") == 3


def test_a_picture_that_cannot_be_used_is_told(tmp_path, capsys):
    (tmp_path / "p.jpg").write_bytes((FOLDER / "woman.jpg").read_bytes())
    request = {"gender": "female", "views": [{"points": {"nose": [1, 1]}}]}
    (tmp_path / "p.json").write_text(json.dumps(request))
    given = [str(tmp_path / "p.jpg"), str(tmp_path / "p.json")]
    with pytest.raises(SystemExit) as ended:
        main(["paper", "--output", str(tmp_path / "out"), "--painting", *given])
    assert ended.value.code == 2
    assert "points" in capsys.readouterr().out
