"""One attempt to deliver a notice to its receiver."""

import asyncio
import ssl
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import httpx

from service.webhooks.addresses import (
    AddressRefusedError,
    IPAddress,
    is_port_refused,
    port_of,
    resolve,
)

CONNECT_WITHIN_S: Final = 5.0
LOOK_UP_WITHIN_S: Final = 5.0
NO_PUBLIC_ADDRESS: Final = "The receiver's name stands for no public address."


@dataclass(frozen=True, slots=True, kw_only=True)
class Answer:
    """The outcome of an attempt: the receiver's status, or the reason why there is none.

    ``retry_after_s`` is what the receiver asked for, if anything; ``cause`` is only for logs.
    """

    status: int | None = None
    error: str | None = None
    cause: str | None = None
    retry_after_s: float | None = None

    @property
    def is_accepted(self) -> bool:
        """Whether the receiver has the notice."""
        return self.status is not None and httpx.codes.is_success(self.status)

    @property
    def is_unwanted(self) -> bool:
        """Whether the receiver wants no more of it."""
        return self.status == httpx.codes.GONE


class Sender:
    """Posts to public addresses at ``ports``, and to ``allowed_hosts`` wherever they are.

    Nothing of this process is sent along: no proxy, no cookies, no credentials. Redirects are not
    followed, and only the head of the answer is read. A name without a public address gets the same
    reason, after the same time, whether or not it is known here.
    """

    def __init__(
        self,
        *,
        allowed_hosts: Collection[str],
        ports: Collection[int],
        time_limit_s: float,
        tls: ssl.SSLContext | None = None,
    ) -> None:
        self._allowed_hosts = allowed_hosts
        self._ports = ports
        self._time_limit_s = time_limit_s
        self._tls = tls or httpx.create_ssl_context()

    async def post(self, url: str, *, headers: Mapping[str, str], body: bytes) -> Answer:
        """Send; never raises because of the receiver or the network."""
        loop = asyncio.get_running_loop()
        began = loop.time()
        told_at = began + min(LOOK_UP_WITHIN_S, self._time_limit_s)
        try:
            target = httpx.URL(url)
            if is_port_refused(target, self._allowed_hosts, self._ports):
                return Answer(error="Notices are not sent to the receiver's port.")
            async with asyncio.timeout_at(told_at):
                addresses = await resolve(
                    target.raw_host.decode(), port_of(target), self._allowed_hosts
                )
        except (AddressRefusedError, TimeoutError) as error:
            await asyncio.sleep(told_at - loop.time())
            return Answer(error=NO_PUBLIC_ADDRESS, cause=str(error) or "The look-up took too long.")
        except httpx.InvalidURL:
            return Answer(error="This is no address of a web server.")
        try:
            async with asyncio.timeout_at(began + self._time_limit_s):
                return await self._post(addresses, target, headers, body)
        except TimeoutError:
            return Answer(error=f"No answer within {self._time_limit_s:g} s.")
        except (httpx.HTTPError, ssl.SSLError) as error:
            # By kind alone: the message may quote the address, or what is there.
            return Answer(error=f"No connection, or none that lasted ({type(error).__name__}).")

    async def _post(
        self,
        addresses: Sequence[IPAddress],
        url: httpx.URL,
        headers: Mapping[str, str],
        body: bytes,
    ) -> Answer:
        for address in addresses[:-1]:
            try:
                return await self._post_to(address, url, headers, body)
            except (httpx.ConnectError, httpx.ConnectTimeout):
                continue
        return await self._post_to(addresses[-1], url, headers, body)

    async def _post_to(
        self, address: IPAddress, url: httpx.URL, headers: Mapping[str, str], body: bytes
    ) -> Answer:
        async with (
            httpx.AsyncClient(
                verify=self._tls,
                trust_env=False,
                # Who calls limits all of it: of two limits that end together chance would tell one.
                timeout=httpx.Timeout(None, connect=CONNECT_WITHIN_S),
            ) as client,
            client.stream(
                "POST",
                url.copy_with(host=str(address)),
                content=body,
                headers={"host": url.netloc.decode(), **headers},
                # The certificate must be for the name, not for the address.
                extensions={"sni_hostname": url.raw_host.decode()},
            ) as response,
        ):
            accepted = response.is_success
            return Answer(
                status=response.status_code,
                error=None if accepted else f"The receiver answered {response.status_code}.",
                retry_after_s=_seconds(response.headers.get("retry-after", "")),
            )


def _seconds(retry_after: str) -> float | None:
    return float(retry_after) if retry_after.isdecimal() and len(retry_after) <= 6 else None
