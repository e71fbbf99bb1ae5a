"""Which addresses a notice may go to: public ones at usual ports, and hosts the settings name.

The caller chooses the address, and the service can reach what the caller cannot: a notice to a
private address would be a request from inside somebody's network. A name is resolved once, its
addresses are checked, and the connection goes to a checked address; resolving the name a second
time could give another one.
"""

import asyncio
import ipaddress
import socket
from collections.abc import Collection, Sequence
from typing import Final

import httpx

from api_schemas.jobs import WebhookTarget
from api_schemas.problems import FieldProblem
from service.settings import Settings

IPAddress = ipaddress.IPv4Address | ipaddress.IPv6Address

GLOBAL_UNICAST: Final = ipaddress.IPv6Network("2000::/3")
NAT64: Final = ipaddress.IPv6Network("64:ff9b::/96")
LOW_32_BITS: Final = 0xFFFFFFFF

SPECIAL: Final = tuple(
    map(
        ipaddress.ip_network,
        (
            # RFC 6890 and 7723: protocols between a host and its own network. The gateway answers
            # at 192.0.0.9, Oracle's metadata at 192.0.0.192.
            "192.0.0.0/24",
            # RFC 7535 and 7450: whichever name server or relay is nearest.
            "192.31.196.0/24",
            "192.52.193.0/24",
            "192.175.48.0/24",
            "2620:4f:8000::/48",
            # RFC 7526: the nearest relay of 6to4, which is no more.
            "192.88.99.0/24",
            # Azure's own services, from every machine in it, and from nowhere else.
            "168.63.129.16/32",
            # RFC 2928: Teredo, benchmarks, identifiers, the gateway at 2001:1::1.
            "2001::/23",
            # RFC 3849 and 9637: documentation.
            "2001:db8::/32",
            "3fff::/20",
            # RFC 3701: the testing network of before, given back.
            "3ffe::/16",
            # RFC 9602: segments of routes within one network.
            "5f00::/16",
        ),
    )
)
"""Networks that are not what a name on the open internet leads to, as IANA's registries of special
addresses have them. Python's own list depends on its release: it is asked as well."""

DEFAULT_PORTS: Final = {"http": 80, "https": 443}

PORTS: Final = (443, 80)
"""Where notices are sent, but for hosts that the settings name."""


class AddressRefusedError(Exception):
    """The name is unknown, or has no address a notice may go to; the message says which.

    The message is for whoever runs the service: callers who saw it could find out which names exist
    in the service's network.
    """


def is_public(address: IPAddress) -> bool:
    """Whether an address, and any IPv4 address embedded in it, is on the open internet."""
    if not address.is_global or address.is_multicast or any(address in each for each in SPECIAL):
        return False
    if isinstance(address, ipaddress.IPv4Address):
        return True
    if address not in GLOBAL_UNICAST and address not in NAT64:
        return False
    return all(map(is_public, _carried(address)))


def _carried(address: ipaddress.IPv6Address) -> list[ipaddress.IPv4Address]:
    """IPv4 addresses at which a packet to this IPv6 address may end up."""
    carried = [address.sixtofour, *(address.teredo or ())]
    if address in NAT64:
        carried.append(ipaddress.IPv4Address(int(address) & LOW_32_BITS))
    return [each for each in carried if each is not None]


def port_of(url: httpx.URL) -> int:
    """The port of an address, explicit or default."""
    return DEFAULT_PORTS[url.scheme] if url.port is None else url.port


def is_port_refused(url: httpx.URL, allowed_hosts: Collection[str]) -> bool:
    """Whether notices are not sent to an address's port; allowed hosts may use any."""
    return url.host not in allowed_hosts and port_of(url) not in PORTS


def target_fault(target: WebhookTarget, settings: Settings) -> FieldProblem | None:
    """Why no notice can be sent there or signed; None if one can, as far as the request says.

    Names are looked up only when a notice is sent.
    """
    try:
        url = httpx.URL(target.url)
    except httpx.InvalidURL:
        return FieldProblem(
            field="webhook.url",
            code="unusable-address",
            reason="This is no address of a web server.",
            remedy="Send an address such as https://example.org/hooks/maquette.",
        )
    allowed_hosts = settings.webhook_hosts
    if is_refused_outright(url.host, allowed_hosts):
        return FieldProblem(
            field="webhook.url",
            code="address-not-public",
            reason="Notices are sent to public addresses only.",
            remedy="Name a public host; whoever runs the service may allow others by "
            "MAQUETTE_WEBHOOK_HOSTS.",
        )
    if is_port_refused(url, allowed_hosts):
        return FieldProblem(
            field="webhook.url",
            code="port-not-allowed",
            reason=f"Notices are not sent to port {port_of(url)}.",
            remedy=f"Receive them at port {' or '.join(map(str, PORTS))}; whoever runs the "
            "service may allow a host's others by MAQUETTE_WEBHOOK_HOSTS.",
        )
    if target.secret is None and settings.webhook_secret is None:
        return FieldProblem(
            field="webhook.secret",
            code="missing",
            reason="This service has no secret of its own to sign notices with.",
            remedy="Send one; make it with: echo whsec_$(openssl rand -base64 32)",
        )
    return None


def is_refused_outright(host: str, allowed_hosts: Collection[str]) -> bool:
    """Whether a host can be refused without resolving it: a literal address, or localhost."""
    if host in allowed_hosts:
        return False
    try:
        return not is_public(ipaddress.ip_address(host))
    except ValueError:
        return host == "localhost" or host.endswith(".localhost")


async def resolve(host: str, port: int, allowed_hosts: Collection[str]) -> Sequence[IPAddress]:
    """Resolve a host and return the addresses a notice may go to, at least one.

    Raises
    ------
    AddressRefusedError
        If there is none.
    """
    try:
        found = await asyncio.get_running_loop().getaddrinfo(host, port, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError) as error:
        message = "The receiver's name cannot be resolved."
        raise AddressRefusedError(message) from error
    # An IPv6 address may come with its zone.
    addresses = [ipaddress.ip_address(str(entry[4][0]).partition("%")[0]) for entry in found]
    if host not in allowed_hosts:
        addresses = [address for address in addresses if is_public(address)]
    if not addresses:
        message = "The receiver's address is not public."
        raise AddressRefusedError(message)
    return list(dict.fromkeys(addresses))
