"""Write what the service is made of, as CycloneDX: packages, the page's libraries, models.

A package has within it the native libraries that its wheel brings along: the files, by what they
were called before the wheel was made and their bytes, and what the wheel's own list says of them.

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
from importlib.metadata import Distribution, distributions
from pathlib import Path
from typing import Any, Final

from page_libraries import page_dependencies, page_libraries
from runtime_requirements import direct, needed, normal, read_lock

Component = dict[str, Any]

UNDECLARED: Final = {"protobuf": "BSD-3-Clause", "qdldl": "Apache-2.0"}
"""Licences that packages bring as a text and do not declare."""

WEIGHTS: Final = ("pose_detection.tflite", "pose_landmark_full.tflite")
CARRIER: Final = re.compile(r"^(mediapipe)==(\S+)", re.MULTILINE)
NATIVE: Final = re.compile(r"lib[^/]+\.so(\.[^/]+)?")
WHEELS_MARK: Final = re.compile(r"-[0-9a-f]{8}(?=[-.])")
"""What tools that make wheels put into the name of a library, so that no two meet."""

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
    parsed = parser.parse_args()
    listed = environment(parsed.python)
    wanted = set(needed(read_lock(Path("requirements.lock").read_text()), direct(PROJECT)))
    packages = [each for each in listed["components"] if normal(each["name"]) in wanted]
    missing = wanted - {normal(each["name"]) for each in packages}
    if missing:
        sys.exit(f"sbom.py: not in the environment: {', '.join(sorted(missing))}")
    for each in packages:
        if "licenses" not in each and normal(each["name"]) in UNDECLARED:
            each["licenses"] = licence(UNDECLARED[normal(each["name"])])
    brought = natives(parsed.python)
    for each in packages:
        if parts := brought.get(normal(each["name"])):
            each["components"] = parts
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


def natives(python: str) -> dict[str, list[Component]]:
    """List the native libraries in the packages of a Python, by the packages' names."""
    asked = [python, "-c", "import sysconfig; print(sysconfig.get_path('platlib'))"]
    folder = subprocess.run(asked, check=True, stdout=subprocess.PIPE, text=True).stdout.strip()
    return {
        normal(each.name): [*native_files(each), *listed_by_wheel(each)]
        for each in distributions(path=[folder])
    }


def native_files(package: Distribution) -> Iterator[Component]:
    """Describe the libraries that a package has as files, as far as they are still there."""
    for file in sorted(package.files or (), key=str):
        path = Path(str(package.locate_file(file)))
        if NATIVE.fullmatch(path.name) and path.is_file():
            name, _, version = WHEELS_MARK.sub("", path.name).partition(".so")
            yield {
                "bom-ref": f"{normal(package.name)}/{file}",
                "type": "library",
                "name": name,
                "hashes": [
                    {"alg": "SHA-256", "content": hashlib.sha256(path.read_bytes()).hexdigest()}
                ],
            } | ({"version": version.removeprefix(".")} if version else {})


def listed_by_wheel(package: Distribution) -> Iterator[Component]:
    """What the wheel's own lists (PEP 770) say was built into it: systems' packages and crates."""
    seen: set[str] = set()
    for file in sorted(package.files or (), key=str):
        path = Path(str(package.locate_file(file)))
        if path.parent.name != "sboms" or path.suffix != ".json" or not path.is_file():
            continue
        for each in json.loads(path.read_text()).get("components", ()):
            purl = each.get("purl", "")
            if purl and not purl.startswith("pkg:pypi/") and purl not in seen:
                seen.add(purl)
                kept = ("type", "name", "version", "purl")
                yield {"bom-ref": f"{normal(package.name)}/{purl}"} | {
                    name: each[name] for name in kept if name in each
                }


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
