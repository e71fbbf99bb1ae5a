"""Alerts and dashboard ask for what the service tells, and each alert has its page."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml
from prometheus_client.parser import text_string_to_metric_families

from tests.external_tools import found, printed
from tests.integration.service.harness import Service

REPOSITORY = Path(__file__).parents[3]
OPERATE = REPOSITORY / "service" / "docs" / "operate"
NOT_OURS = {"up"}
METRIC = re.compile(r"\bmaquette_\w+")
MATCHED = re.compile(r"(\bmaquette_\w+)\{([^}]*)\}")
LABEL = re.compile(r'(\w+)(=~|!~|!=|=)"([^"]*)"')
TARGETS = {"job", "instance"}
"""Labels that Prometheus gives to what it scrapes."""


def alerts() -> list[dict[str, Any]]:
    (group,) = yaml.safe_load((OPERATE / "alerts.yaml").read_text())["groups"]
    return group["rules"]


def panels() -> list[dict[str, Any]]:
    return json.loads((OPERATE / "dashboard.json").read_text())["panels"]


def expressions() -> Iterator[str]:
    for each in alerts():
        yield each["expr"]
    for panel in panels():
        for target in panel["targets"]:
            yield target["expr"]


@pytest.fixture(scope="module")
def told(service: Service) -> dict[str, set[str]]:
    """The names of all samples that a running service prints, with the labels of each."""
    # What is counted only once it was asked for.
    service.client.post("/v1/bodies", json={"gender": "female"})
    service.ended(service.submit())
    text = service.client.get("/metrics").raise_for_status().text
    labels: dict[str, set[str]] = {}
    for family in text_string_to_metric_families(text):
        # A family of which nothing has been counted yet has no samples, but tells its name.
        labels.setdefault(family.name, set())
        for sample in family.samples:
            labels.setdefault(sample.name, set()).update(sample.labels)
    return labels


def test_every_metric_asked_for_is_told_and_has_the_labels(told: dict[str, set[str]]):
    asked = list(expressions())
    names = {name for each in asked for name in METRIC.findall(each)}
    assert names
    assert names <= set(told)
    for each in asked:
        for name, matchers in MATCHED.findall(each):
            labels = {label for label, _, _ in LABEL.findall(matchers)}
            assert labels <= told[name] | TARGETS, each


def test_every_metric_told_is_shown(told: dict[str, set[str]]):
    shown = {
        name for panel in panels() for t in panel["targets"] for name in METRIC.findall(t["expr"])
    }
    ours = {name for name in told if name.startswith("maquette_")}
    families = {re.sub(r"_(total|bucket|sum|count|created)$", "", name) for name in ours}
    assert families == {re.sub(r"_(total|bucket|sum|count)$", "", name) for name in shown}


def test_promtool_accepts_the_rules_and_they_fire_when_they_should():
    promtool = found("promtool", package="prometheus")
    assert f"SUCCESS: {len(alerts())} rules found" in printed(
        promtool, "check", "rules", str(OPERATE / "alerts.yaml")
    )
    printed(promtool, "test", "rules", str(OPERATE / "alerts.test.yaml"))
    (rules_file,) = yaml.safe_load((OPERATE / "alerts.test.yaml").read_text())["rule_files"]
    assert rules_file == "alerts.yaml"


def test_every_alert_is_seen_to_fire_and_to_be_silent():
    quiet, loud = yaml.safe_load((OPERATE / "alerts.test.yaml").read_text())["tests"]
    names = {each["alert"] for each in alerts()}
    assert names == {each["alertname"] for each in quiet["alert_rule_test"]}
    assert names == {each["alertname"] for each in loud["alert_rule_test"] if "exp_alerts" in each}
    assert not any(each.get("exp_alerts") for each in quiet["alert_rule_test"])


@pytest.mark.parametrize("alert", alerts(), ids=lambda each: each["alert"])
def test_an_alert_says_what_it_means_and_where_to_read_on(alert: dict[str, Any]):
    assert set(alert["annotations"]) == {"summary", "description", "runbook"}
    page, _, section = alert["annotations"]["runbook"].partition("#")
    headings = re.findall(r"^## (.*)$", (REPOSITORY / page).read_text(), re.MULTILINE)
    assert section == alert["alert"].lower()
    assert alert["alert"] in headings
    assert alert["labels"]["severity"] in {"critical", "warning"}


def test_states_in_matchers_are_states(service: Service):
    text = service.client.get("/metrics").raise_for_status().text
    for each in expressions():
        for name, matchers in MATCHED.findall(each):
            for label, how, value in LABEL.findall(matchers):
                if label == "state":
                    assert how in {"=", "=~"}
                    for state in value.split("|"):
                        assert f'{name}{{state="{state}"}}' in text


def test_it_is_the_dashboard_of_prometheus_metrics():
    for panel in panels():
        assert panel["title"]
        assert panel["targets"]
        assert panel["datasource"]["type"] == "prometheus"
