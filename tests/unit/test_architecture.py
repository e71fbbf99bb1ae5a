"""ARCHITECTURE.md is short, and speaks of the packages and modules there are."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / "ARCHITECTURE.md").read_text()
TRAINING = (ROOT / "fitter" / "training" / "README.md").read_text()
MOST_LINES = 200


def quoted(text: str) -> set[str]:
    return set(re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", text, flags=re.DOTALL)))


def packages(*parts: str) -> Iterator[str]:
    folder = ROOT.joinpath(*parts)
    for each in sorted(folder.iterdir()):
        if (each / "__init__.py").exists():
            yield each.name


def modules() -> Iterator[str]:
    for top in ("fitter", "service", "api_schemas", "tests"):
        for path in (ROOT / top).rglob("*.py"):
            yield path.relative_to(ROOT).with_suffix("").as_posix()
    for path in (ROOT / "service" / "page" / "src").rglob("*.ts*"):
        yield path.relative_to(ROOT).with_suffix("").as_posix()


def test_it_is_read_in_a_few_minutes():
    assert len(TEXT.splitlines()) <= MOST_LINES


@pytest.mark.parametrize(
    ("parts", "text"),
    [(("fitter",), TEXT), (("service",), TEXT), (("fitter", "training"), TRAINING)],
)
def test_every_package_is_named(parts, text):
    named = " ".join(quoted(text))
    missing = [each for each in packages(*parts) if not re.search(rf"\b{each}\b", named)]
    assert missing == []


def test_every_module_that_is_named_by_its_package_exists():
    there = list(modules())
    named = {
        each.removesuffix(".py")
        for each in quoted(TEXT) | quoted(TRAINING)
        if re.fullmatch(r"[a-z_]+(/[a-z_]+)+(\.py)?", each)
    }
    assert named
    gone = [
        each
        for each in sorted(named)
        if not any(
            f"/{path}/".endswith(f"/{each}/") or f"/{each}/" in f"/{path}/" for path in there
        )
        and not (ROOT / each).exists()
        and not any(ROOT.glob(f"fitter/**/{each}"))
    ]
    assert gone == []
