"""The page and the reports show the same measurements first."""

import re
from pathlib import Path

from fitter.measurement.groups import CHIEF

READING = Path(__file__).parents[3] / "service" / "page" / "src" / "result" / "reading.ts"


def test_the_page_shows_first_what_reports_show_first():
    source = READING.read_text(encoding="utf-8")
    (listed,) = re.findall(r"CHIEF: ReadonlySet<string> = new Set\(\[(.*?)\]\)", source, re.DOTALL)
    assert tuple(re.findall(r'"(\w+)"', listed)) == CHIEF
