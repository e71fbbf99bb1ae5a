"""A fork server of the tests' process, of which there is one for all test files."""

import os
import signal
from multiprocessing.connection import Connection

from service.compute.fork_server import ForkServer, end


def started_anew(server: ForkServer) -> ForkServer:
    """End the server that runs; the next one loads what is asked for, with the variables of now."""
    connection, process = server.start(_tell_server)
    os.kill(connection.recv(), signal.SIGKILL)
    end(connection, process)
    return server


def _tell_server(connection: Connection) -> None:
    connection.send(os.getppid())
