"""The audit of dependencies never takes silence for a good answer."""

import json
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.dependency_audit import LOCK, SOURCES, main

SKIPPED = {"name": "scipy", "skip_reason": "Dependency not found on PyPI and could not be audited"}
SOUND = {"name": "numpy", "version": "2.4.6", "vulns": []}
VULNERABLE = {
    "name": "pillow",
    "version": "1.0",
    "vulns": [{"id": "PYSEC-1", "fix_versions": ["1.1"]}],
}


def program(folder: Path, reports: dict[str, list[dict[str, Any]] | None]) -> str:
    """A program that is called like pip-audit and knows what each source answers; None if none."""
    path = folder / "pip-audit"
    path.write_text(
        f"#!{sys.executable}\n"
        "import json, sys\n"
        f"reports = json.loads({json.dumps(json.dumps(reports))})\n"
        "options = dict(zip(sys.argv, sys.argv[1:]))\n"
        f"assert options['--requirement'] == {str(LOCK)!r}\n"
        "found = reports[options['--vulnerability-service']]\n"
        "if found is None:\n"
        "    sys.exit('ConnectionError')\n"
        "open(options['--output'], 'w').write(json.dumps({'dependencies': found}))\n"
        "sys.exit(any(each.get('vulns') for each in found))\n"
    )
    path.chmod(0o755)
    return str(path)


@pytest.mark.parametrize(("pypi", "osv"), [(None, None), ([SKIPPED], None), ([SKIPPED], [SKIPPED])])
def test_where_nobody_knows_a_package_it_says_that_nothing_was_audited(tmp_path, capsys, pypi, osv):
    assert main(program(tmp_path, {"pypi": pypi, "osv": osv})) == 0
    assert "NOT audited" in capsys.readouterr().out


def test_where_there_is_no_pip_audit_it_says_that_nothing_was_audited(tmp_path, capsys):
    assert main(str(tmp_path / "nothing")) == 0
    assert "NOT audited" in capsys.readouterr().out


@pytest.mark.parametrize("source", SOURCES)
def test_a_known_vulnerability_fails_and_is_named_whoever_knows_it(tmp_path, capsys, source):
    reports = {"pypi": None, "osv": None} | {source: [SOUND, SKIPPED, VULNERABLE]}
    assert main(program(tmp_path, reports)) == 1
    printed = capsys.readouterr().out
    assert f"2 packages audited by {source}, 1 not known there." in printed
    assert "pillow 1.0: PYSEC-1, mended in 1.1" in printed


def test_packages_without_known_vulnerabilities_pass(tmp_path, capsys):
    assert main(program(tmp_path, {"pypi": [SOUND], "osv": None})) == 0
    assert "1 packages audited by pypi, 0 not known there." in capsys.readouterr().out
