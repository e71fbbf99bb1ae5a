"""Data that lies beside the repository, in ../shared/data, and is not shipped with it."""

from pathlib import Path

import pytest

SHARED_DATA = Path(__file__).resolve().parents[2] / "shared" / "data"
NOT_SHIPPED = "which is not shipped"


def needs_shared(path: Path) -> pytest.MarkDecorator:
    """Skip where a file of the shared data is missing, and say which."""
    name = path.relative_to(SHARED_DATA)
    return pytest.mark.skipif(
        not path.exists(), reason=f"needs ../shared/data/{name}, {NOT_SHIPPED}"
    )
