"""An S3-compatible server on this machine, for one run."""

import contextlib
import uuid
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import boto3
from moto.server import ThreadedMotoServer

REGION = "eu-central-1"
CREDENTIALS: Mapping[str, str] = {
    "AWS_ACCESS_KEY_ID": "key",
    "AWS_SECRET_ACCESS_KEY": "secret",
}


def variable(setting: tuple[str, object]) -> tuple[str, str]:
    """The environment's variable for a setting of ours or, by its name, of the S3 client."""
    name, value = setting[0].upper(), str(setting[1])
    return (name if name.startswith("AWS_") else f"MAQUETTE_{name}"), value


@dataclass(frozen=True)
class ObjectStorage:
    """Where the server listens, and the name of a bucket that nobody has made yet."""

    endpoint_url: str
    bucket: str

    @property
    def blob_url(self) -> str:
        """Where the service's blobs lie."""
        return f"s3://{self.bucket}/blobs"

    @property
    def settings(self) -> dict[str, str]:
        """What a process of the service is to be told."""
        return {
            "blob_url": self.blob_url,
            "aws_endpoint_url_s3": self.endpoint_url,
            "aws_default_region": REGION,
        }

    @property
    def client(self) -> Any:
        """A client of its own, which looks past the service."""
        return boto3.client(
            "s3",
            endpoint_url=self.endpoint_url,
            region_name=REGION,
            aws_access_key_id=CREDENTIALS["AWS_ACCESS_KEY_ID"],
            aws_secret_access_key=CREDENTIALS["AWS_SECRET_ACCESS_KEY"],
        )

    def object_names(self) -> list[str]:
        """The names of all objects in the bucket."""
        return [
            entry["Key"]
            for page in self.client.get_paginator("list_objects_v2").paginate(Bucket=self.bucket)
            for entry in page.get("Contents", ())
        ]


@contextlib.contextmanager
def running_object_storage(address: str = "127.0.0.1") -> Iterator[ObjectStorage]:
    """Run the server in this process, on a free port."""
    server = ThreadedMotoServer(ip_address=address, port=0, verbose=False)
    server.start()
    try:
        host, port = server.get_host_and_port()
        yield ObjectStorage(f"http://{host}:{port}", f"test-{uuid.uuid4().hex[:12]}")
    finally:
        server.stop()
