"""Whether Maquette runs here: `make` asks before it installs anything."""

import platform
import sys

SYSTEMS = "Linux with glibc, on x86-64 or arm64"


def fault(system, machine, libc, python):
    """Say in a sentence why Maquette does not run, None if it does."""
    if system != "Linux" or libc != "glibc" or machine not in ("x86_64", "aarch64"):
        return f"Maquette runs on {SYSTEMS}. Elsewhere run its image: docker/Dockerfile."
    if python < (3, 11):
        return "Maquette needs Python 3.11 or newer: make PYTHON=..."
    return None


if __name__ == "__main__":
    sys.exit(
        fault(platform.system(), platform.machine(), platform.libc_ver()[0], sys.version_info[:2])
    )
