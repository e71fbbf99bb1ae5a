"""A page to print: what is asked for, and what comes of it."""

from typing import Literal

from api_schemas.products.base import ProductOptions, ProductResult


class PrintOptions(ProductOptions):
    """One page in English, A4: pictures, body, measurements with how they are taken, remarks."""

    kind: Literal["print"]


class PrintResult(ProductResult):
    """``print.html``, which needs no other file."""

    kind: Literal["print"] = "print"
