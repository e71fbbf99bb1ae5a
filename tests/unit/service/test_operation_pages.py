"""The pages for whoever runs the service: what they name exists, and limits agree."""

import re
from pathlib import Path

import pytest

from service.api.app import IDLE_S
from service.api.events import MAX_WAIT_S, PING_S
from service.jobs.tables import METADATA
from service.settings import PREFIX, Settings
from tests.readme import block

OPERATE = Path(__file__).parents[3] / "service" / "docs" / "operate"
PAGES = sorted(OPERATE.glob("*.md"))
PROXY = (OPERATE / "proxy.md").read_text()
HEAD_S = 20


def setting(name: str) -> float:
    return Settings.model_fields[name].default


def anchors(page: Path) -> set[str]:
    """What the headings of a page are linked by."""
    headings = re.findall(r"^#+ (.*)$", page.read_text(), re.MULTILINE)
    return {re.sub(r"[^\w -]", "", each).lower().replace(" ", "-") for each in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_leads_to_something(page: Path):
    for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text()):
        if target.startswith("https://"):
            continue
        path, _, section = target.partition("#")
        linked = page.parent / path if path else page
        assert linked.exists(), target
        assert not section or section in anchors(linked), target


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_setting_named_is_one(page: Path):
    named = set(re.findall(rf"\b{PREFIX}([A-Z0-9_]+)\b", page.read_text()))
    assert {name.lower() for name in named} <= set(Settings.model_fields)


def test_every_page_is_in_the_list():
    listed = set(re.findall(r"\((\w+\.md)\)", (OPERATE / "index.md").read_text()))
    assert listed == {page.name for page in PAGES} - {"index.md"}


def test_the_table_of_keys_is_called_so():
    assert "maquette_api_keys" in METADATA.tables
    assert "maquette_api_keys" in (OPERATE / "storage.md").read_text()


def seconds(name: str, text: str) -> float:
    (value,) = re.findall(rf"\b{name} (\d+)s", text)
    return float(value)


def test_nginx_waits_for_as_long_as_the_service_may_take():
    example = block("nginx", PROXY)
    (megabytes,) = re.findall(r"client_max_body_size (\d+)m;", example)
    assert int(megabytes) * 1024**2 >= setting("max_upload_bytes")
    assert seconds("client_header_timeout", example) == HEAD_S
    assert f"take longer than {HEAD_S} s" in PROXY
    assert seconds("client_body_timeout", example) == setting("body_time_limit_s")
    assert seconds("proxy_read_timeout", example) > max(MAX_WAIT_S, PING_S)
    assert seconds("keepalive_timeout", example) < IDLE_S


def test_caddy_waits_for_as_long_as_the_service_may_take():
    example = block("caddy", PROXY)
    (megabytes,) = re.findall(r"max_size (\d+)MB", example)
    assert int(megabytes) * 1000**2 >= setting("max_upload_bytes")
    assert seconds("response_header_timeout", example) > MAX_WAIT_S
    assert seconds("keepalive", example) < IDLE_S
