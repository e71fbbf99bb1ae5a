"""Imported first by the fork server: it and all it forks give way to the API and the worker."""

import os
from typing import Final

NICENESS: Final = 5

os.nice(NICENESS)
