"""The Kubernetes manifests as a cluster gets them."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import yaml

from tests.external_tools import found, printed

Manifest = dict[str, Any]

REPOSITORY = Path(__file__).parents[1]
FOLDER = REPOSITORY / "docker" / "kubernetes"
EXAMPLE = FOLDER / "overlays" / "example"
OLDEST_KUSTOMIZE = 5


@cache
def rendered(folder: Path = EXAMPLE) -> tuple[Manifest, ...]:
    """All manifests of an overlay, rendered by kubectl; skips where there is none new enough."""
    kubectl = found("kubectl", package="kubernetes-client")
    version = json.loads(printed(kubectl, "version", "--client", "--output=json"))
    kustomize = version.get("kustomizeVersion", "v0")
    if int(kustomize.removeprefix("v").split(".")[0]) < OLDEST_KUSTOMIZE:
        pytest.skip(f"kubectl has kustomize {kustomize}; version {OLDEST_KUSTOMIZE} is needed")
    return tuple(yaml.safe_load_all(printed(kubectl, "kustomize", str(folder))))


def of_kind(*kinds: str) -> dict[str, Manifest]:
    """The manifests of these kinds, by name."""
    return {each["metadata"]["name"]: each for each in rendered() if each["kind"] in kinds}


def the(kind: str, name: str) -> Manifest:
    """The specification of the one manifest with this kind and name."""
    return of_kind(kind)[name]["spec"]


def pods() -> dict[str, Manifest]:
    """The pod templates, by the name of the component they run."""
    templates = [each["spec"]["template"] for each in of_kind("Deployment", "Job").values()]
    return {each["metadata"]["labels"]["app.kubernetes.io/component"]: each for each in templates}


def container(component: str) -> Manifest:
    """The only container of a component's pods."""
    (only,) = pods()[component]["spec"]["containers"]
    return only


def settings_map() -> dict[str, str]:
    """What all pods get from the map of settings."""
    (only,) = of_kind("ConfigMap").values()
    return only["data"]
