"""Kernels that are compiled already, read from their cache without a fit.

Numba reads a compiled kernel when it is first called with arguments of its types. This reads all
that are in the cache for the fitter's modules that have been imported, and is the only file that
relies on private parts of Numba's cache and of its libraries; a test names it.

With each kernel Numba keeps LLVM's representation of it, of which only a kernel that is compiled
later and calls it has any need: three quarters of all that kernels take in memory. Here it is kept
as bitcode, a tenth of that.
"""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

from numba.core import codegen
from numba.core.caching import FunctionCache
from numba.core.registry import CPUDispatcher

PACKAGE: Final = "fitter."

LLVM: Final[Any] = vars(codegen)["ll"]
"""What Numba itself calls LLVM by."""


def load_compiled_kernels() -> float:
    """Read what is compiled; return the share of kernels of which something was there to read.

    A few are called by other kernels alone, or by what few ask for, and never have anything.
    """
    found = [_load(kernel) for kernel in _kernels()]
    return sum(found) / len(found) if found else 0.0


def _kernels() -> Iterator[Any]:
    modules = [module for name, module in sys.modules.items() if name.startswith(PACKAGE)]
    kernels: dict[int, Any] = {
        id(value): value
        for module in modules
        for value in vars(module).values()
        if isinstance(value, CPUDispatcher)
    }
    # Those without a cache are part of others.
    return (each for each in kernels.values() if isinstance(each._cache, FunctionCache))


def _load(kernel: Any) -> bool:
    """Read a kernel for all types it is compiled for; say whether there are any."""
    cache = kernel._cache
    generator = kernel.targetctx.codegen()
    # An entry may be of another processor or of other code: asked for, it would be compiled.
    types = [
        key[0]
        for key in cache._cache_file._load_index()
        if key == cache._index_key(key[0], generator)
    ]
    for each in types:
        kernel.compile(each)
    for compiled in kernel.overloads.values():
        _shrink(compiled.library)
    return bool(types)


@dataclass(frozen=True, slots=True)
class _Bitcode:
    """In place of a library's module: Numba links into others what its ``clone`` returns."""

    content: bytes

    def clone(self) -> Any:
        return LLVM.parse_bitcode(self.content)


def _shrink(library: Any) -> None:
    """Keep as bitcode what others would link; a library compiled here keeps what it is made of."""
    if isinstance(library._shared_module, LLVM.ModuleRef) and library._disable_inspection:
        library._shared_module = _Bitcode(library._shared_module.as_bitcode())
