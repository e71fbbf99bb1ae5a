"""Checks of everything the service depends on, before anything is started."""

from service.blobs import BlobStore, open_blob_store, setting_of_storage
from service.engine.database import check_database
from service.engine.storage_identity import check_storage
from service.process.data_folder import prepare_data_folder
from service.settings import Settings
from service.worker.model_files import check_detector, check_models


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
