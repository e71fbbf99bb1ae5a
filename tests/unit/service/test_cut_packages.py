"""What is cut from the packages of an image, and what stays."""

import importlib.metadata
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import botocore
import pytest

SCRIPT = Path(__file__).parents[3] / "docker" / "cut_packages.py"

GONE = (
    "numpy/lib/tests/data/array.npy",
    "numpy/lib/tests/tests/test_it.py",
    "numpy/_core/include/arrays.h",
    "ai_edge_litert/libLiteRtWebGpuAccelerator.so",
    "ai_edge_litert/tools/convert.py",
    "botocore/data/ec2/service-2.json.gz",
)
LEFT = (
    "numpy/lib/arrays.py",
    "numpy/testing/overrides.py",
    "trimesh/__init__.pyi",
    "ai_edge_litert/libLiteRt.so",
    "botocore/data/endpoints.json",
    "botocore/data/s3/service-2.json.gz",
)


def cut(folder: Path) -> str:
    command = [sys.executable, SCRIPT, folder]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def test_what_a_service_never_reads_is_erased_and_nothing_else(tmp_path: Path):
    for name in (*GONE, *LEFT):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(bytes(1_000_000))
    printed = cut(tmp_path)
    left = {str(each.relative_to(tmp_path)) for each in tmp_path.rglob("*") if each.is_file()}
    assert left == set(LEFT)
    assert [line.split()[0] for line in printed.splitlines()] == ["2.0", "1.0", "1.0", "2.0"]


def test_no_library_that_a_wheel_brings_is_one_that_nothing_links():
    """Else it is for the cut, as OpenSSL 1.1.1 will be once OpenCV's FFmpeg needs it no more."""
    packages = Path(sysconfig.get_path("platlib"))
    names = ("opencv_python_headless", "psycopg_binary", "pi_heif", "pillow", "numpy", "scipy")
    for name in names:
        brought = [*(packages / f"{name}.libs").iterdir()]
        folder = importlib.metadata.distribution(name)
        binaries = {
            Path(str(each.locate())).resolve()
            for each in folder.files or ()
            if ".so" in each.name and Path(str(each.locate())).is_file()
        }
        contents = {path: path.read_bytes() for path in binaries}
        for library in brought:
            # As the string table of whoever links it has it.
            linked = b"\0" + library.name.encode() + b"\0"
            users = [path for path, content in contents.items() if linked in content]
            assert set(users) - {library.resolve()}, library.name


@pytest.fixture
def storage_client_alone(tmp_path: Path) -> Path:
    """botocore as the image has it."""
    shutil.copytree(Path(botocore.__file__).parent, tmp_path / "botocore")
    cut(tmp_path)
    return tmp_path


def test_the_storage_s_client_can_be_made_of_what_is_left(storage_client_alone: Path):
    made = (
        "import boto3, botocore; print(botocore.__file__);"
        "client = boto3.client('s3', region_name='eu-central-1');"
        "print(client.get_paginator('list_objects_v2'), client.get_waiter('bucket_exists'))"
    )
    done = subprocess.run(
        [sys.executable, "-c", made],
        env={"PYTHONPATH": str(storage_client_alone), "AWS_ACCESS_KEY_ID": "key"}
        | {"AWS_SECRET_ACCESS_KEY": "secret"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith(str(storage_client_alone))
