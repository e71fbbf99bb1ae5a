"""The Kubernetes manifest: settings, commands and rights of its pods."""

from pathlib import Path
from typing import Any

import pytest
import yaml

from service.cli import parse
from service.settings import PREFIX, Settings
from service.version import VERSION

REPOSITORY = Path(__file__).parents[3]
MANIFESTS = list(yaml.safe_load_all((REPOSITORY / "docker" / "kubernetes.yaml").read_text()))
(SETTINGS,) = (each["data"] for each in MANIFESTS if each["kind"] == "ConfigMap")
PODS: dict[str, Any] = {
    each["metadata"]["name"]: each["spec"]["template"]["spec"]
    for each in MANIFESTS
    if each["kind"] == "Deployment"
}


def container(pod: Any) -> Any:
    (only,) = pod["containers"]
    return only


def test_the_map_holds_settings_that_can_be_followed():
    named = {
        name.removeprefix(PREFIX).lower(): value
        for name, value in SETTINGS.items()
        if name.startswith(PREFIX)
    }
    assert named.keys() <= Settings.model_fields.keys()
    # Nothing is kept in a pod.
    assert not Settings.model_validate_strings(named).uses_data_folder


@pytest.mark.parametrize("name", PODS)
def test_every_pod_runs_our_image_with_a_command_of_ours_and_no_more_rights_than_it_needs(name):
    pod, only = PODS[name], container(PODS[name])
    assert only["image"].endswith(f"/maquette:{VERSION}")
    asked = [only["args"], *(each["exec"]["command"] for each in _probes(only) if "exec" in each)]
    for program, *arguments in asked:
        assert program == "maquette"
        parse(arguments)
    assert pod["automountServiceAccountToken"] is pod["enableServiceLinks"] is False
    assert pod["securityContext"]["runAsNonRoot"] is True
    assert only["securityContext"] == {
        "allowPrivilegeEscalation": False,
        "readOnlyRootFilesystem": True,
        "capabilities": {"drop": ["ALL"]},
    }


def test_a_pod_is_given_longer_than_it_takes_to_stop():
    given = {name: pod["terminationGracePeriodSeconds"] for name, pod in PODS.items()}
    assert given["worker"] >= float(SETTINGS[f"{PREFIX}DRAIN_S"]) + 20.0
    assert given["api"] >= float(SETTINGS[f"{PREFIX}STOP_DELAY_S"]) + 20.0


def test_selectors_find_the_pods_they_mean():
    (service,) = (each for each in MANIFESTS if each["kind"] == "Service")
    labels = {
        each["metadata"]["name"]: each["spec"]["template"]["metadata"]["labels"]
        for each in MANIFESTS
        if each["kind"] == "Deployment"
    }
    assert service["spec"]["selector"] == labels["api"]
    for each in MANIFESTS:
        if each["kind"] == "Deployment":
            assert each["spec"]["selector"]["matchLabels"] == labels[each["metadata"]["name"]]


def _probes(only: Any) -> list[Any]:
    return [value for name, value in only.items() if name.endswith("Probe")]
