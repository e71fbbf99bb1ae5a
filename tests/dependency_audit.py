"""Look for known vulnerabilities of the locked packages, where a list of them can be reached.

``python -m tests.dependency_audit PIP_AUDIT`` asks the sources in turn and believes the first that
knows packages at all: a mirror without PyPI's list of vulnerabilities answers "not found" to every
question, which ``pip-audit`` counts as no vulnerability. Ends with 1 if there are any, and with 0
where nobody could be asked, but says so.
"""

import json
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

SOURCES: Final = ("pypi", "osv")
LOCK: Final = Path(__file__).parents[1] / "requirements.lock"
PATIENCE_S: Final = 600.0


def main(command: str) -> int:
    """Audit, and print what was found."""
    for source in SOURCES:
        packages = answers(command, source)
        audited = [each for each in packages if "skip_reason" not in each]
        if audited:
            return told(source, audited, unknown=len(packages) - len(audited))
    print("Dependencies were NOT audited: no list of known vulnerabilities can be reached.")
    return 0


def answers(command: str, source: str) -> Sequence[Mapping[str, Any]]:
    """What a source says of each locked package; nothing if it does not answer."""
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        asked = [command, "--requirement", str(LOCK), "--disable-pip", "--require-hashes"]
        asked += ["--vulnerability-service", source, "--progress-spinner", "off"]
        asked += ["--format", "json", "--output", str(report)]
        try:
            subprocess.run(asked, check=False, capture_output=True, timeout=PATIENCE_S)
        except (OSError, subprocess.TimeoutExpired) as error:
            print(f"{source}: {type(error).__name__}.")
            return ()
        # It fails both where there are vulnerabilities and where nobody answers: only the former
        # is reported.
        return json.loads(report.read_text())["dependencies"] if report.exists() else ()


def told(source: str, audited: Sequence[Mapping[str, Any]], *, unknown: int) -> int:
    """Print what a source knows; 1 if it knows any vulnerability."""
    print(f"{len(audited)} packages audited by {source}, {unknown} not known there.")
    vulnerable = [(each, fault) for each in audited for fault in each["vulns"]]
    for package, fault in vulnerable:
        fixed = ", ".join(fault.get("fix_versions", ())) or "no version yet"
        print(f"{package['name']} {package['version']}: {fault['id']}, mended in {fixed}")
    return 1 if vulnerable else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
