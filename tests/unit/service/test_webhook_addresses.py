import asyncio
import ipaddress

import pytest

from service.jobs.notices import NotAcceptedError, is_public, is_refused_outright, resolve

PRIVATE = [
    "0.0.0.0",
    "10.1.2.3",
    "100.64.0.1",
    "127.0.0.1",
    "127.8.8.8",
    "169.254.169.254",
    "172.16.0.1",
    "192.0.0.1",
    "192.0.0.8",
    "192.0.0.9",
    "192.0.0.170",
    "192.0.0.192",
    "192.0.2.1",
    "192.31.196.1",
    "192.52.193.1",
    "192.88.99.1",
    "192.88.99.2",
    "192.175.48.1",
    "168.63.129.16",
    "192.168.0.1",
    "198.18.0.1",
    "198.51.100.1",
    "203.0.113.1",
    "224.0.0.1",
    "240.0.0.1",
    "255.255.255.255",
    "::",
    "::1",
    "::127.0.0.1",
    "::ffff:127.0.0.1",
    "::ffff:169.254.169.254",
    "64:ff9b::10.0.0.1",
    "64:ff9b::192.88.99.1",
    "64:ff9b:1::1",
    # Translations of other addresses, public ones too.
    "64:ff9b::1.1.1.1",
    "2002:101:101::",
    "100::1",
    "100:0:0:1::1",
    "2002:7f00:1::",
    "2002:c058:6301::",
    "2001:0:7f00:1::",
    "2001:1::1",
    "2001:2::1",
    "2001:4:112::1",
    "2001:20::1",
    "2620:4f:8000::1",
    "3ffe::1",
    "3fff::1",
    "3fff:fff:ffff::1",
    "5f00::1",
    "fc00::1",
    "fd00:ec2::254",
    "fe80::1",
    "fec0::1",
    "ff02::1",
    "2001:db8::1",
]
PUBLIC = [
    "1.1.1.1",
    "93.184.216.34",
    # Neighbours of special networks.
    "192.0.1.1",
    "192.88.98.1",
    "192.88.100.1",
    "168.63.129.15",
    "2001:200::1",
    "2606:4700:4700::1111",
    "3fff:1000::1",
]


@pytest.mark.parametrize("address", PRIVATE)
def test_no_notice_goes_to_an_address_that_is_not_public(address):
    assert not is_public(ipaddress.ip_address(address))
    assert is_refused_outright(address, ())
    with pytest.raises(NotAcceptedError, match="not public"):
        asyncio.run(resolve(address, ()))


@pytest.mark.parametrize("address", PUBLIC)
def test_public_addresses_are_public(address):
    assert is_public(ipaddress.ip_address(address))
    assert not is_refused_outright(address, ())
    assert asyncio.run(resolve(address, ())) == [ipaddress.ip_address(address)]


@pytest.mark.parametrize("host", ["127.1", "0x7f000001", "2130706433", "localhost", "0177.0.0.1"])
def test_other_ways_to_write_this_machine_are_found_out_when_they_are_looked_up(host):
    with pytest.raises(NotAcceptedError):
        asyncio.run(resolve(host, ()))


def test_a_name_of_public_and_private_addresses_leads_to_the_public_ones(monkeypatch):
    async def lookup(host, port, **_):
        return [(2, 1, 6, "", (each, port)) for each in ("10.0.0.1", "1.1.1.1", "127.0.0.1")]

    async def resolved():
        monkeypatch.setattr(asyncio.get_running_loop(), "getaddrinfo", lookup)
        return await resolve("mixed.example", ())

    assert asyncio.run(resolved()) == [ipaddress.ip_address("1.1.1.1")]


def test_hosts_the_settings_name_may_be_anywhere():
    assert asyncio.run(resolve("127.0.0.1", ("127.0.0.1",)))
    assert not is_refused_outright("localhost", ("localhost",))


def test_an_unknown_name_says_so():
    with pytest.raises(NotAcceptedError, match="resolved"):
        asyncio.run(resolve("no-such-host.invalid", ()))
