"""Compiled code gives the same bits in the process that compiles it and in those that load it."""

import os
import subprocess
import sys
from pathlib import Path

ROWS = """
import hashlib
import numpy as np
from fitter.optimizer import _row_kernels as kernels

draws = np.random.default_rng(1)
vertices, parts, shapes, rows = 60, 16, 20, 40
points = kernels.Points(
    positions=draws.normal(size=(vertices, 3)),
    joint_follow=draws.random((vertices, parts)),
    part_weights=draws.random((vertices, parts)),
    shape_basis=draws.normal(size=(vertices, shapes, 3)),
)
frame = kernels.Frame(
    translation=draws.normal(size=3),
    rotations=draws.normal(size=(parts, 3, 3)),
    parent_rotations=draws.normal(size=(parts, 3, 3)),
    joints=draws.normal(size=(parts, 3)),
    joint_offsets=draws.normal(size=(shapes, parts, 3)),
)
result = np.empty((rows, 3 * parts + 3 + shapes))
kernels.position_row_jacobian(
    draws.normal(size=(rows, 2, 3)),
    draws.integers(0, vertices, size=(rows, 2)),
    draws.random(rows),
    points,
    frame,
    result,
)
print(hashlib.sha256(result.tobytes()).hexdigest())
"""


def rows_digest(kernels: Path) -> str:
    """Digest of rows that a process has computed whose compiled code is kept in that folder."""
    environment = os.environ | {"NUMBA_CACHE_DIR": str(kernels)}
    done = subprocess.run(
        [sys.executable, "-c", ROWS], env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout


def test_compiling_and_loading_give_the_same_bits(tmp_path: Path):
    compiled, loaded = rows_digest(tmp_path), rows_digest(tmp_path)
    assert list(tmp_path.rglob("*.nbc"))
    assert compiled == loaded
