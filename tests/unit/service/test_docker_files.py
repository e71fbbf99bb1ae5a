import re
from pathlib import Path

import pytest
import yaml

from service.settings import PREFIX, Settings

DOCKER = Path(__file__).parents[3] / "docker"


@pytest.mark.parametrize("name", ["Dockerfile", "compose.yaml"])
def test_every_variable_of_ours_is_a_setting(name):
    variables = set(re.findall(rf"\b{PREFIX}(\w+)", (DOCKER / name).read_text()))
    assert variables
    assert {variable.lower() for variable in variables} <= set(Settings.model_fields)


def test_no_container_of_ours_may_write_outside_its_volumes_or_gain_rights():
    services = yaml.safe_load((DOCKER / "compose.yaml").read_text())["services"]
    for name in ("api", "worker"):
        assert services[name]["read_only"]
        assert services[name]["cap_drop"] == ["ALL"]
        assert services[name]["security_opt"] == ["no-new-privileges:true"]


def test_the_image_does_not_run_as_root():
    instructions = (DOCKER / "Dockerfile").read_text().splitlines()
    users = [line.split()[1] for line in instructions if line.startswith("USER ")]
    assert users[-1] != "root"
