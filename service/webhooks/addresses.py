"""Which addresses a notice may go to: public ones at usual ports, and hosts the settings name.

A caller chooses the address, and the service stands where the caller may not: a notice to a private
address would be a request from inside somebody's network. A name is looked up once, what it stands
for is checked, and that very address is connected to; a second look-up could answer otherwise.
"""

import asyncio
import ipaddress
import socket
from collections.abc import Collection, Sequence
from typing import Final

import httpx

IPAddress = ipaddress.IPv4Address | ipaddress.IPv6Address

GLOBAL_UNICAST: Final = ipaddress.IPv6Network("2000::/3")
NAT64: Final = ipaddress.IPv6Network("64:ff9b::/96")
LOW_32_BITS: Final = 0xFFFFFFFF
DEFAULT_PORTS: Final = {"http": 80, "https": 443}


class AddressRefusedError(Exception):
    """The name is unknown, or stands for no address a notice may go to; the message says which.

    That is for whoever runs the service: callers who were told could find out by trying which names
    there are in the network that the service stands in.
    """


def is_public(address: IPAddress) -> bool:
    """Say whether an address, and any IPv4 address it carries inside, is on the open internet."""
    if not address.is_global or address.is_multicast:
        return False
    if isinstance(address, ipaddress.IPv4Address):
        return True
    if address not in GLOBAL_UNICAST and address not in NAT64:
        return False
    return all(map(is_public, _carried(address)))


def _carried(address: ipaddress.IPv6Address) -> list[ipaddress.IPv4Address]:
    """IPv4 addresses a packet to this IPv6 address may end up at."""
    carried = [address.sixtofour, *(address.teredo or ())]
    if address in NAT64:
        carried.append(ipaddress.IPv4Address(int(address) & LOW_32_BITS))
    return [each for each in carried if each is not None]


def is_refused_outright(host: str, allowed_hosts: Collection[str]) -> bool:
    """Say whether a host can be refused without looking it up: a literal address, or localhost."""
    if host in allowed_hosts:
        return False
    try:
        return not is_public(ipaddress.ip_address(host))
    except ValueError:
        return host == "localhost" or host.endswith(".localhost")


def port_of(url: httpx.URL) -> int:
    """The port of an address, named or usual."""
    return DEFAULT_PORTS[url.scheme] if url.port is None else url.port


def is_port_refused(url: httpx.URL, allowed_hosts: Collection[str], ports: Collection[int]) -> bool:
    """Say whether an address has a port that notices are not sent to; a named host has any."""
    return url.host not in allowed_hosts and port_of(url) not in ports


async def resolve(host: str, port: int, allowed_hosts: Collection[str]) -> Sequence[IPAddress]:
    """Look a host up and return the addresses a notice may go to, at least one.

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
