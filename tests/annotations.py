"""What `make test-shapes` checks the fitter's annotations with: beartype, once for a signature.

jaxtyping's hook makes two stand-ins of every function, with its signature and no content, and has
these checked. Of a function within a function it makes new ones at every call around it, and
beartype takes milliseconds for each: ten times what a search does besides. They are the same.
"""

from collections.abc import Callable, Hashable
from types import FunctionType
from typing import Any, Final

from beartype import BeartypeConf, beartype

_CHECK: Final = beartype(conf=BeartypeConf(is_pep484_tower=True))
_CHECKED: Final[dict[Hashable, Callable[..., Any]]] = {}


def checked(stand_in: FunctionType) -> Callable[..., Any]:
    """The stand-in, which fails where arguments or result are not as announced."""
    code = stand_in.__code__
    parameters = (code.co_varnames, code.co_posonlyargcount, code.co_kwonlyargcount, code.co_flags)
    announced = tuple(stand_in.__annotations__.items())
    signature = (stand_in.__module__, stand_in.__qualname__, parameters, announced)
    if signature not in _CHECKED:
        _CHECKED[signature] = _CHECK(stand_in)
    return _CHECKED[signature]
