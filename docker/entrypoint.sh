#!/bin/sh
# The image's compiled kernels are read-only, and Numba insists on a folder it can write: it gets one
# of links to them. What it compiles beyond them lies there until the container ends.
set -e
cp -rsf /opt/maquette/kernels/. "$NUMBA_CACHE_DIR"
exec "$@"
