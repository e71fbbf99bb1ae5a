"""Write what the service is made of, as CycloneDX: packages, the page's libraries, models.

Run from the repository's root, by a Python that has cyclonedx-bom. The environment that is
described is that of ``--python``; of its packages those are listed that a container runs with.
"""

import argparse
import hashlib
import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from page_libraries import page_dependencies, page_libraries
from runtime_requirements import direct, needed, normal, read_lock

Component = dict[str, Any]

UNDECLARED: Final = {"protobuf": "BSD-3-Clause", "qdldl": "Apache-2.0"}
"""Licences that packages bring as a text and do not declare."""

WEIGHTS: Final = ("pose_detection.tflite", "pose_landmark_full.tflite")
CARRIER: Final = re.compile(r"^(mediapipe)==(\S+)", re.MULTILINE)
MODELS: Final = Path("fitter/body/data")
PROJECT: Final = Path("pyproject.toml")
VERSION: Final = re.compile(r'^VERSION = "(.+)"$', re.MULTILINE)


def main() -> None:
    """Write the list."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", required=True, metavar="FILE", help="whose environment")
    parser.add_argument(
        "--detector", required=True, type=Path, metavar="DIR", help="of the weights"
    )
    parser.add_argument("--output", required=True, type=Path, metavar="FILE")
    parser.add_argument("extras", nargs="*", help="that the service is run with beside the usual")
    parsed = parser.parse_args()
    listed = environment(parsed.python)
    wanted = set(
        needed(read_lock(Path("requirements.lock").read_text()), direct(PROJECT, parsed.extras))
    )
    packages = [each for each in listed["components"] if normal(each["name"]) in wanted]
    missing = wanted - {normal(each["name"]) for each in packages}
    if missing:
        sys.exit(f"sbom.py: not in the environment: {', '.join(sorted(missing))}")
    for each in packages:
        if "licenses" not in each and normal(each["name"]) in UNDECLARED:
            each["licenses"] = licence(UNDECLARED[normal(each["name"])])
    version = own_version()
    models = [*weights(parsed.detector), *body_models(version)]
    libraries = page_libraries()
    listed["components"] = [*packages, *libraries, *models]
    kept = {each["bom-ref"] for each in listed["components"]}
    project = listed["metadata"]["component"]
    project["version"] = version
    root = project["bom-ref"]
    listed["dependencies"] = [
        edges | {"dependsOn": [ref for ref in edges.get("dependsOn", ()) if ref in kept]}
        for edges in listed["dependencies"]
        if edges["ref"] in kept | {root}
    ] + page_dependencies()
    for edges in listed["dependencies"]:
        if edges["ref"] == root:
            edges["dependsOn"] += [each["bom-ref"] for each in libraries]
    parsed.output.parent.mkdir(parents=True, exist_ok=True)
    parsed.output.write_text(json.dumps(listed, indent=1, sort_keys=True) + "\n")


def environment(python: str) -> Component:
    """List all packages that a Python finds."""
    command = [sys.executable, "-m", "cyclonedx_py", "environment", python, "--pyproject", PROJECT]
    command += ["--mc-type", "application", "--of", "JSON", "--output-reproducible"]
    printed = subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout
    return json.loads(printed)


def weights(folder: Path) -> Iterator[Component]:
    """List the detector's networks, which are files of a package that is not installed."""
    carrier = CARRIER.search(Path("requirements-detector.txt").read_text())
    assert carrier, "the file names the package"
    name, version = carrier.groups()
    for file in WEIGHTS:
        (path,) = folder.rglob(file)
        yield model(path, version=version, licence_id="Apache-2.0") | {
            "purl": f"pkg:pypi/{name}@{version}#{file}",
            "supplier": {"name": "The MediaPipe Authors, Google"},
        }


def own_version() -> str:
    """Read the version where the build reads it."""
    found = VERSION.search(Path("service/version.py").read_text())
    assert found, "the project has a version"
    return found[1]


def body_models(version: str) -> Iterator[Component]:
    """List the body models, which are of the project's own version."""
    for path in sorted(MODELS.glob("*.npz")):
        yield model(path, version=version, licence_id="Apache-2.0")


def model(path: Path, *, version: str, licence_id: str) -> Component:
    """Describe a trained model by its file."""
    digest = hashlib.sha256(path.read_bytes()).hexdigest()
    return {
        "bom-ref": path.name,
        "type": "machine-learning-model",
        "name": path.name,
        "version": version,
        "licenses": licence(licence_id),
        "hashes": [{"alg": "SHA-256", "content": digest}],
    }


def licence(identifier: str) -> list[Component]:
    """Name one licence."""
    return [{"license": {"acknowledgement": "declared", "id": identifier}}]


if __name__ == "__main__":
    main()
