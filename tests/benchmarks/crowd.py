"""A crowd of callers in a process of its own: listeners to events, and pollers of jobs.

Started with the port, the number of pollers and the ids of jobs on standard input; lives until its
standard input ends, then prints what it has seen.
"""

import asyncio
import contextlib
import json
import subprocess
import sys
from collections.abc import Iterator, Sequence

POLL_EVERY_S = 1.0
HEAD_END = b"\r\n\r\n"


@contextlib.contextmanager
def crowd(port: int, *, listening_to: Sequence[str], polling: Sequence[str]) -> Iterator[None]:
    """Let each job of the first be listened to, and each of the second be polled every second."""
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.benchmarks.crowd"],
        stdin=subprocess.PIPE,
        text=True,
    )
    assert process.stdin is not None
    orders = {"port": port, "listening_to": list(listening_to), "polling": list(polling)}
    process.stdin.write(json.dumps(orders) + "\n")
    process.stdin.flush()
    try:
        yield
    finally:
        process.stdin.close()
        process.wait()


async def _live(orders: dict) -> None:
    port = orders["port"]
    tasks = [
        *(asyncio.create_task(_listen(port, path)) for path in orders["listening_to"]),
        *(asyncio.create_task(_poll(port, path)) for path in orders["polling"]),
    ]
    await asyncio.to_thread(sys.stdin.read)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


async def _listen(port: int, path: str) -> None:
    reader, writer = await _connected(port)
    with contextlib.closing(writer):
        writer.write(_request(f"{path}/events", "close"))
        while await reader.read(65_536):
            pass


async def _poll(port: int, path: str) -> None:
    reader, writer = await _connected(port)
    with contextlib.closing(writer):
        while True:
            writer.write(_request(path, "keep-alive"))
            head = await reader.readuntil(HEAD_END)
            length = next(
                int(line.split(b":")[1])
                for line in head.lower().split(b"\r\n")
                if line.startswith(b"content-length")
            )
            await reader.readexactly(length)
            await asyncio.sleep(POLL_EVERY_S)


async def _connected(port: int) -> tuple[asyncio.StreamReader, asyncio.StreamWriter]:
    return await asyncio.open_connection("127.0.0.1", port)


def _request(path: str, connection: str) -> bytes:
    return f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: {connection}\r\n\r\n".encode()


if __name__ == "__main__":
    asyncio.run(_live(json.loads(sys.stdin.readline())))
