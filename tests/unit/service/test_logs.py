"""What the log levels let through, in a process of its own each."""

import json
import subprocess
import sys

COMPILES = """
import logging
from service.process.logs import configure_logging

configure_logging("{level}")
import numba

logging.getLogger("service.something").debug("ours at DEBUG")
logging.getLogger("asyncio").debug("theirs at DEBUG")
logging.getLogger("asyncio").info("theirs at INFO")
assert numba.njit(lambda number: number + 1)(1) == 2
"""


def said_at(level: str) -> str:
    program = COMPILES.format(level=level)
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    ).stderr


def test_at_debug_we_tell_more_and_the_libraries_do_not():
    said = said_at("DEBUG")
    assert "ours at DEBUG" in said
    assert "theirs at INFO" in said
    assert "theirs at DEBUG" not in said
    assert "numba" not in said


def test_a_higher_level_holds_for_all():
    assert "ours" not in said_at("INFO")
    assert said_at("WARNING") == ""


DBOS_IN_AN_OUTAGE = """
from service.process.logs import configure_logging

configure_logging("INFO", "json")
import dbos
import logging
from sqlalchemy.exc import OperationalError

away = OperationalError("SELECT", {}, Exception("connection refused"))
try:
    raise away
except OperationalError:
    import traceback
    logging.getLogger("dbos").warning(f"Exception polling: {traceback.format_exc()}")
logging.getLogger("dbos").warning(f"Exception listing: {away}")
logging.getLogger("dbos").error("A fault:\\nwith its frames")
"""


def test_dbos_logs_as_we_do_and_an_outage_in_one_line():
    said = subprocess.run(
        [sys.executable, "-c", DBOS_IN_AN_OUTAGE], capture_output=True, text=True, check=True
    ).stderr
    polling, listing, fault = [json.loads(line)["message"] for line in said.splitlines()]
    cause = "(builtins.Exception) connection refused"
    assert polling == f"Exception polling: sqlalchemy.exc.OperationalError: {cause}"
    assert listing.startswith("Exception listing: ")
    assert fault == "A fault:\nwith its frames"
