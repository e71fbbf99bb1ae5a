"""The manifests of docker/kubernetes: valid, sealed, and in step with settings and versions."""

import copy
import json
import os
import subprocess

import kubernetes_validate
import pytest

from service.cli import _parser
from service.settings import PREFIX, Settings
from service.version import VERSION
from tests.external_tools import found
from tests.manifests import (
    REPOSITORY,
    Manifest,
    container,
    of_kind,
    pods,
    rendered,
    settings_map,
    the,
)
from tests.npm_packages import installed

KUBERNETES = "1.32"
KEDA = REPOSITORY / "tests" / "keda_schemas"
COMPONENTS = ("api", "worker", "prepare")
STAYING = ("api", "worker")
SECRET_NAMES = {
    "PGPASSWORD",
    "AWS_ACCESS_KEY_ID",
    "AWS_SECRET_ACCESS_KEY",
    "MAQUETTE_WEBHOOK_SECRET",
}


def is_kedas(manifest: Manifest) -> bool:
    return manifest["apiVersion"].startswith("keda.sh/")


def keda_faults(manifests: list[Manifest]) -> list[str | None]:
    """What KEDA's schemas find in each manifest."""
    node = found("node", package="nodejs")
    command = [node, str(installed(KEDA) / "validate.js")]
    done = subprocess.run(
        command, input=json.dumps(manifests), capture_output=True, text=True, check=True
    )
    return json.loads(done.stdout)


def selects(selector: Manifest, pod: Manifest) -> bool:
    """Whether a selector by labels holds for the pods of a template."""
    assert set(selector) <= {"matchLabels"}
    return selector.get("matchLabels", {}).items() <= pod["metadata"]["labels"].items()


def selected(selector: Manifest) -> set[str]:
    return {name for name, pod in pods().items() if selects(selector, pod)}


def test_kubernetes_schemas_hold_for_every_manifest_of_its_own():
    for manifest in rendered():
        if not is_kedas(manifest):
            kubernetes_validate.validate(manifest, KUBERNETES, strict=True)


def test_kubernetes_schemas_find_a_name_that_is_none():
    api = copy.deepcopy(of_kind("Deployment")["api"])
    api["spec"]["template"]["spec"]["containers"][0]["livenesProbe"] = {}
    with pytest.raises(kubernetes_validate.ValidationError, match="livenesProbe"):
        kubernetes_validate.validate(api, KUBERNETES, strict=True)


def test_keda_s_schemas_hold_for_its_resources_and_are_awake():
    ours = [each for each in rendered() if is_kedas(each)]
    assert {each["kind"] for each in ours} == {"ScaledObject", "TriggerAuthentication"}
    assert keda_faults(ours) == [None] * len(ours)
    damaged = copy.deepcopy(ours)
    for each in damaged:
        # A text stands where each kind has a list.
        each["spec"] |= {"triggers": "none", "secretTargetRef": "none"}
    assert None not in keda_faults(damaged)


def test_how_fast_workers_come_and_go_is_what_kubernetes_knows():
    scaling = the("ScaledObject", "worker")
    scaler = {
        "apiVersion": "autoscaling/v2",
        "kind": "HorizontalPodAutoscaler",
        "metadata": {"name": "worker"},
        "spec": {
            "scaleTargetRef": {"kind": "Deployment", **scaling["scaleTargetRef"]},
            "maxReplicas": scaling["maxReplicaCount"],
            "minReplicas": scaling["minReplicaCount"],
            "behavior": scaling["advanced"]["horizontalPodAutoscalerConfig"]["behavior"],
        },
    }
    kubernetes_validate.validate(scaler, KUBERNETES, strict=True)


def test_workers_are_scaled_by_keda_alone_from_one_on():
    scaling = the("ScaledObject", "worker")
    assert scaling["scaleTargetRef"]["name"] in of_kind("Deployment")
    assert "replicas" not in the("Deployment", "worker")
    assert scaling["minReplicaCount"] >= 1
    by_name = {each["name"]: each for each in scaling["triggers"]}
    assert by_name["waiting"]["metadata"]["valueLocation"] == "maquette_queue_oldest_seconds"
    assert (
        by_name["running"]["metadata"]["targetValue"] == settings_map()[f"{PREFIX}WORKER_PROCESSES"]
    )
    (service,) = of_kind("Service").values()
    namespace = service["metadata"]["namespace"]
    (port,) = service["spec"]["ports"]
    for each in scaling["triggers"]:
        assert each["metadata"]["url"] == (
            f"http://{service['metadata']['name']}.{namespace}.svc:{port['port']}/metrics"
        )
        assert each["authenticationRef"]["name"] in of_kind("TriggerAuthentication")


@pytest.mark.parametrize("component", COMPONENTS)
def test_every_variable_of_ours_is_a_setting_of_a_value_that_can_be_followed(
    component, monkeypatch
):
    (source,) = container(component)["envFrom"]
    assert source == {"configMapRef": {"name": next(iter(of_kind("ConfigMap")))}}
    named = settings_map().keys() | {each["name"] for each in container(component)["env"]}
    ours = {name for name in named if name.startswith(PREFIX)}
    assert {name.removeprefix(PREFIX).lower() for name in ours} <= set(Settings.model_fields)
    for name in list(os.environ):
        if name.startswith(PREFIX):
            monkeypatch.delenv(name)
    for name, value in settings_map().items():
        monkeypatch.setenv(name, value)
    settings = Settings()
    # Nothing is kept in a pod.
    assert not settings.uses_data_folder


@pytest.mark.parametrize("component", COMPONENTS)
def test_secrets_are_named_and_never_told(component):
    named = {each["name"]: each for each in container(component)["env"]}
    notices = {"MAQUETTE_WEBHOOK_SECRET"}
    assert set(named) == (SECRET_NAMES if component == "api" else SECRET_NAMES - notices)
    for name, each in named.items():
        reference = each["valueFrom"]["secretKeyRef"]
        assert set(each) == {"name", "valueFrom"}
        assert (reference["name"], reference["key"]) == ("maquette", name)
        assert bool(reference.get("optional")) == (name in notices)
    assert not of_kind("Secret")
    assert SECRET_NAMES.isdisjoint(settings_map())


def test_images_have_the_version_of_the_project():
    for component in COMPONENTS:
        assert container(component)["image"].rpartition(":")[2] == VERSION
        base = REPOSITORY / "docker" / "kubernetes" / "base" / f"{component}.yaml"
        assert f"image: maquette:{VERSION}\n" in base.read_text()
    assert set(of_kind("Job")) == {f"prepare-{VERSION.replace('.', '-')}"}


@pytest.mark.parametrize("component", COMPONENTS)
def test_no_pod_has_more_rights_than_it_needs(component):
    pod = pods()[component]["spec"]
    assert pod["automountServiceAccountToken"] is False
    # Or a Service could set what looks like a setting.
    assert pod["enableServiceLinks"] is False
    assert pod["securityContext"]["runAsNonRoot"] is True
    assert pod["securityContext"]["seccompProfile"] == {"type": "RuntimeDefault"}
    only = container(component)
    assert only["securityContext"] == {
        "allowPrivilegeEscalation": False,
        "readOnlyRootFilesystem": True,
        "capabilities": {"drop": ["ALL"]},
    }
    assert [each["mountPath"] for each in only["volumeMounts"]] == ["/tmp"]
    assert [set(each) for each in pod["volumes"]] == [{"name", "emptyDir"}]
    for bound in ("requests", "limits"):
        assert set(only["resources"][bound]) == {"cpu", "memory", "ephemeral-storage"}
    labels = of_kind("Namespace")["maquette"]["metadata"]["labels"]
    assert labels["pod-security.kubernetes.io/enforce"] == "restricted"


def test_every_command_and_probe_is_one_of_ours():
    asked = [container(component)["args"] for component in COMPONENTS]
    for component in STAYING:
        for probe in ("startupProbe", "readinessProbe", "livenessProbe"):
            test = container(component)[probe]
            if "exec" in test:
                asked.append(test["exec"]["command"])
            else:
                assert test["httpGet"]["path"] in {"/healthz/live", "/healthz/ready"}
    for program, *arguments in asked:
        assert program == "maquette"
        _parser().parse_args(arguments)


def test_a_pod_is_given_longer_than_it_takes_to_stop():
    given = {name: pods()[name]["spec"]["terminationGracePeriodSeconds"] for name in STAYING}
    settings = settings_map()
    assert given["worker"] >= float(settings[f"{PREFIX}DRAIN_S"]) + 20.0
    assert given["api"] >= float(settings[f"{PREFIX}STOP_DELAY_S"]) + 20.0


def test_selectors_find_the_pods_they_mean():
    for name in STAYING:
        deployment = the("Deployment", name)
        assert selected(deployment["selector"]) == {name}
        assert selected(the("PodDisruptionBudget", name)["selector"]) == {name}
        for spread in pods()[name]["spec"]["topologySpreadConstraints"]:
            assert selected(spread["labelSelector"]) == {name}
    assert selected({"matchLabels": the("Service", "api")["selector"]}) == {"api"}
    (path,) = the("Ingress", "maquette")["rules"][0]["http"]["paths"]
    assert path["backend"]["service"] == {"name": "api", "port": {"name": "http"}}
    assert {each["name"] for each in container("api")["ports"]} == {"http"}


def test_nothing_goes_in_or_out_but_what_a_policy_lets_through():
    policies = {name: each["spec"] for name, each in of_kind("NetworkPolicy").items()}
    denied = policies.pop("default-deny")
    assert denied == {"podSelector": {}, "policyTypes": ["Ingress", "Egress"]}
    let_through: dict[str, set[tuple[str, str]]] = {}
    for name, policy in policies.items():
        for component in selected(policy["podSelector"]):
            for direction in policy["policyTypes"]:
                let_through.setdefault(component, set()).add((direction, name))
    needed = {
        ("Egress", "to-dns"),
        ("Egress", "to-database"),
        ("Egress", "to-storage"),
        ("Egress", "to-collector"),
    }
    assert let_through == {
        "worker": needed,
        "prepare": needed,
        "api": needed | {("Egress", "api-to-receivers"), ("Ingress", "api-callers")},
    }
    # No rule is without ends or ports, which would stand for all of them.
    for policy in policies.values():
        for rule in [*policy.get("egress", ()), *policy.get("ingress", ())]:
            assert rule.get("to") or rule.get("from")
            assert rule["ports"]


def test_notices_have_a_way_out_to_public_addresses_at_the_ports_of_the_settings():
    (rule,) = the("NetworkPolicy", "api-to-receivers")["egress"]
    default = Settings.model_fields["webhook_ports"].default
    assert {str(each["port"]) for each in rule["ports"]} == set(default.split(","))
    four, six = (each["ipBlock"] for each in rule["to"])
    assert {"10.0.0.0/8", "172.16.0.0/12", "192.168.0.0/16", "169.254.0.0/16"} <= set(
        four["except"]
    )
    assert six == {"cidr": "2000::/3"}
