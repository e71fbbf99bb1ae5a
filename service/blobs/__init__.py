"""Pictures and results as blobs: on the local disk, or in S3-compatible object storage.

Blobs live in scopes, one per job, and are named by their content. Nothing is shared between scopes,
so erasing a job erases one scope, without reference counting. The database holds only names of
blobs: what a caller sent (picture, mask, points, whom to notify and with what secret) and what was
made from it is here and nowhere else.
"""

from service.blobs.port import (
    BlobMissingError,
    BlobStore,
    BlobsUnavailableError,
    StorageFullError,
    StorageRefusedError,
    StorageUnusableError,
)
from service.blobs.selection import open_blob_store, setting_of_storage

__all__ = [
    "BlobMissingError",
    "BlobStore",
    "BlobsUnavailableError",
    "StorageFullError",
    "StorageRefusedError",
    "StorageUnusableError",
    "open_blob_store",
    "setting_of_storage",
]
