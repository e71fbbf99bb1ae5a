"""Records of products as callers see them."""

from typing import Final
from uuid import UUID

from api_schemas.jobs import JobState
from api_schemas.products import Product, ProductLinks, product_result
from api_schemas.products.base import ProductKind
from service.jobs.inputs import RESULT
from service.jobs.records import JobRecord, StoredBlob
from service.representation.jobs import fit_path

PRODUCTS: Final = "products"
"""Where they lie below their fit."""


def product_path(fit_id: str, product_id: str) -> str:
    """Path of a product below the service's root."""
    return f"{fit_path(fit_id)}/{PRODUCTS}/{product_id}"


def product_files(record: JobRecord) -> dict[str, StoredBlob]:
    """The files that were made, without what there is to say of them."""
    return {name: file for name, file in record.made.items() if name != RESULT}


def represent_product(record: JobRecord, result: bytes | None) -> Product:
    """Translate a record; ``result`` is what is stored of what there is to say."""
    assert record.parent is not None
    assert record.product is not None
    path = product_path(record.parent, record.product)
    done = record.state is JobState.SUCCEEDED
    return Product(
        id=record.product,
        kind=ProductKind(record.kind),
        fit_id=UUID(record.parent),
        state=record.state,
        progress=record.progress,
        problem=record.problem,
        result=None if result is None else product_result(result),
        links=ProductLinks(
            self=path,
            fit=fit_path(record.parent),
            files={name: f"{path}/files/{name}" for name in product_files(record)} if done else {},
        ),
    )
