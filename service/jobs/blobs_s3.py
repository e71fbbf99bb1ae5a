"""Blobs as objects in S3-compatible storage: ``prefix/scope/sha256`` in one bucket.

Server, region and credentials come from where every S3 client looks for them:
``AWS_ENDPOINT_URL_S3``, ``AWS_DEFAULT_REGION``, ``AWS_ACCESS_KEY_ID`` and
``AWS_SECRET_ACCESS_KEY``, a shared file, or the machine's role.
"""

import contextlib
import hashlib
import os
import uuid
from collections.abc import Iterable, Iterator
from typing import Any, Final

import boto3
from botocore.config import Config
from botocore.exceptions import BotoCoreError, ClientError

from service.jobs.blobs import (
    BlobDamagedError,
    BlobMissingError,
    BlobsUnavailableError,
    StorageFullError,
    StorageRefusedError,
)

MISSING: Final = frozenset({"NoSuchKey", "404", "NotFound"})
FULL: Final = frozenset({"XMinioStorageFull", "QuotaExceeded", "InsufficientStorage", "507"})
REFUSED: Final = frozenset(
    {
        "AccessDenied",
        "AuthorizationHeaderMalformed",
        "BucketAlreadyExists",
        "IllegalLocationConstraintException",
        "InvalidAccessKeyId",
        "InvalidBucketName",
        "InvalidLocationConstraint",
        "PermanentRedirect",
        "SignatureDoesNotMatch",
    }
)
"""Errors that are answered until name, region, credentials or rights are corrected."""

ENDPOINT: Final = "AWS_ENDPOINT_URL_S3"
"""Names a server that is not Amazon's."""

UNVERSIONED: Final = frozenset({"NotImplemented", "MethodNotAllowed"})
"""Errors of servers that do not support versions when asked for them."""

UNNAMED_REGIONS: Final = frozenset({None, "us-east-1", "aws-global"})
"""The region of a new bucket that names none; naming this one is refused."""

LISTED_AT_ONCE: Final = 1000
"""Objects per page of a listing: the most that servers return."""

CONNECTIONS: Final = 32
CONNECT_TIMEOUT_S: Final = 3
READ_TIMEOUT_S: Final = 10
ATTEMPTS: Final = 2


class S3BlobStore:
    """Content-addressed objects below a prefix of a bucket."""

    def __init__(self, *, bucket: str, prefix: str) -> None:
        self._bucket = bucket
        self._prefix = f"{prefix.strip('/')}/" if prefix.strip("/") else ""
        self._client: Any = boto3.client(
            "s3",
            config=Config(
                connect_timeout=CONNECT_TIMEOUT_S,
                read_timeout=READ_TIMEOUT_S,
                retries={"mode": "standard", "total_max_attempts": ATTEMPTS},
                max_pool_connections=CONNECTIONS,
                # Many S3-compatible servers know neither buckets as host names nor the newer
                # checksums; the content is checked by its name instead.
                s3={"addressing_style": "path" if ENDPOINT in os.environ else "auto"},
                request_checksum_calculation="when_required",
                response_checksum_validation="when_required",
            ),
        )

    def prepare(self) -> None:
        """Create the bucket unless it exists; like every new bucket it is private."""
        region = self._client.meta.region_name
        place = {} if region in UNNAMED_REGIONS else {"LocationConstraint": region}
        options = {"CreateBucketConfiguration": place} if place else {}
        with (
            _told(self._bucket),
            contextlib.suppress(self._client.exceptions.BucketAlreadyOwnedByYou),
        ):
            # Asked first: a key need not be allowed to make what is there.
            if not self._bucket_exists():
                self._client.create_bucket(Bucket=self._bucket, **options)

    def _bucket_exists(self) -> bool:
        try:
            self._client.list_objects_v2(Bucket=self._bucket, MaxKeys=1)
        except self._client.exceptions.NoSuchBucket:
            return False
        return True

    def put(self, scope: str, content: bytes) -> str:
        """Store ``content`` and return its SHA-256, its name in the scope."""
        digest = hashlib.sha256(content).hexdigest()
        with _told(digest):
            self._client.put_object(Bucket=self._bucket, Key=self._key(scope, digest), Body=content)
        return digest

    def put_all(self, scope: str, contents: Iterable[bytes]) -> list[str]:
        """Store several at once, and return their names."""
        return [self.put(scope, content) for content in contents]

    def get(self, scope: str, name: str) -> bytes:
        """Read a blob.

        Raises
        ------
        BlobMissingError
            If it was erased or never stored.
        BlobDamagedError
            If what came is not what was stored.
        """
        with _told(name):
            answer = self._client.get_object(Bucket=self._bucket, Key=self._key(scope, name))
            content: bytes = answer["Body"].read()
        if hashlib.sha256(content).hexdigest() != name:
            raise BlobDamagedError(name)
        return content

    def scopes(self) -> Iterator[str]:
        """Return the scopes that hold anything, in no order."""
        pages = self._client.get_paginator("list_objects_v2")
        with _told(self._bucket):
            for page in pages.paginate(Bucket=self._bucket, Prefix=self._prefix, Delimiter="/"):
                for entry in page.get("CommonPrefixes", ()):
                    yield entry["Prefix"].removeprefix(self._prefix).rstrip("/")

    def erase(self, scope: str) -> None:
        """Remove everything in a scope, in every version a bucket with versioning kept."""
        with _told(scope):
            # Listed to the end first: not every server continues a listing after an object that is
            # gone. Deleted one by one: batches need a checksum that not every server accepts.
            for version in list(self._versions(f"{self._prefix}{scope}/")):
                self._client.delete_object(Bucket=self._bucket, **version)

    def check_writable(self) -> None:
        """Write and remove an object."""
        scope = f".probe-{uuid.uuid4().hex}"
        self.put(scope, b"probe")
        self.erase(scope)

    def _key(self, scope: str, name: str) -> str:
        return f"{self._prefix}{scope}/{name}"

    def _versions(self, prefix: str) -> Iterator[dict[str, str]]:
        try:
            yield from self._listed("list_object_versions", prefix)
        except ClientError as error:
            if error.response.get("Error", {}).get("Code") not in UNVERSIONED:
                raise
            yield from self._listed("list_objects_v2", prefix)

    def _listed(self, operation: str, prefix: str) -> Iterator[dict[str, str]]:
        pages = self._client.get_paginator(operation)
        size = {"PageSize": LISTED_AT_ONCE}
        for page in pages.paginate(Bucket=self._bucket, Prefix=prefix, PaginationConfig=size):
            for kind in ("Versions", "DeleteMarkers", "Contents"):
                for entry in page.get(kind, ()):
                    version = {"Key": entry["Key"]}
                    if entry.get("VersionId") not in (None, "null"):
                        version["VersionId"] = entry["VersionId"]
                    yield version


@contextlib.contextmanager
def _told(name: str) -> Iterator[None]:
    """Turn the client's errors into the store's own."""
    try:
        yield
    except ClientError as error:
        code = str(error.response.get("Error", {}).get("Code", ""))
        if code in MISSING:
            raise BlobMissingError(name) from error
        kind = (
            StorageFullError
            if code in FULL
            else StorageRefusedError
            if code in REFUSED
            else BlobsUnavailableError
        )
        message = f"the object storage answered {code}"
        raise kind(message) from error
    except BotoCoreError as error:
        message = f"the object storage cannot be reached ({type(error).__name__})"
        raise BlobsUnavailableError(message) from error
