"""Which blob store the settings ask for."""

from urllib.parse import urlsplit

from service.blobs.local import LocalBlobStore
from service.blobs.port import BlobStore
from service.settings import PREFIX, SettingError, Settings


def setting_of_storage(settings: Settings) -> str:
    """The setting that says where blobs are, as an operator would write it."""
    if settings.blob_url is None:
        return f"{PREFIX}DATA_DIR={settings.data_dir}"
    return f"{PREFIX}BLOB_URL={settings.blob_url}"


def open_blob_store(settings: Settings) -> BlobStore:
    """Open the store named by ``blob_url``: ``s3://bucket/prefix``, or the data folder if unset.

    Raises
    ------
    SettingError
        If S3 is asked for and its client is not installed.
    """
    if settings.blob_url is None:
        return LocalBlobStore(settings.blob_dir)
    url = urlsplit(settings.blob_url)
    try:
        # Only here: the client is an extra, and takes a third of a second to load.
        from service.blobs.s3 import S3BlobStore
    except ImportError as error:
        message = "S3 needs the client; install it with: pip install 'maquette[s3]'"
        raise SettingError(message, name="blob_url", value=settings.blob_url) from error
    return S3BlobStore(bucket=url.netloc, prefix=url.path)
