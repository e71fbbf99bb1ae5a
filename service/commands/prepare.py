"""``maquette prepare``: create what API and workers expect to exist before they start."""

from service.blobs import open_blob_store, setting_of_storage
from service.engine.database import prepare_database
from service.engine.storage_identity import make_storage, take_storage
from service.process.data_folder import prepare_data_folder
from service.settings import Settings


def prepare(settings: Settings, *, adopt_storage: bool = False) -> int:
    """Create the tables and the folder or bucket of the blobs; what exists is kept.

    With ``adopt_storage`` the storage takes the place of the one that the database had.

    Raises
    ------
    SettingError
        If the data folder cannot be used.
    StorageUnusableError
        If the bucket cannot be had, or is not the database's.
    BlobsUnavailableError
        If the bucket does not answer within two minutes.
    """
    prepare_data_folder(settings)
    url, named = settings.system_database_url, setting_of_storage(settings)
    prepare_database(url)
    blobs = open_blob_store(settings)
    make_storage(blobs, named=named)
    take_storage(url, blobs, named=named, adopt=adopt_storage)
    return 0
