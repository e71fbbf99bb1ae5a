"""What API and workers expect to exist before they start: created by ``maquette prepare``."""

from service.compute.models_reading import check_detector, check_models
from service.jobs.blobs import BlobStore, open_blob_store, setting_of_storage
from service.jobs.database import check_database, prepare_database
from service.jobs.storage_identity import check_storage, make_storage, take_storage
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


def run_preflight(settings: Settings) -> BlobStore:
    """Check data folder, models, detector, database and storage, and return the last.

    Waits for a database or a storage that does not answer.

    Raises
    ------
    SettingError
        If folder, models or detector cannot be used.
    DatabaseUnusableError
        If the database cannot be used.
    StorageUnusableError
        If the storage cannot be used, or is that of another database.
    """
    prepare_data_folder(settings)
    check_models(settings)
    check_detector(settings)
    check_database(settings.system_database_url)
    blobs = open_blob_store(settings)
    check_storage(settings.system_database_url, blobs, named=setting_of_storage(settings))
    return blobs
