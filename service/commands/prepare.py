"""``maquette prepare``: create what API and workers expect to exist before they start."""

from service.blobs import open_blob_store
from service.engine.database import prepare_database
from service.process.data_folder import prepare_data_folder
from service.settings import Settings
from service.worker.retrying import retry_while_storage_is_away


def prepare(settings: Settings) -> int:
    """Create the tables and the folder or bucket of the blobs; what exists is kept.

    Raises
    ------
    SettingError
        If the data folder cannot be used.
    BlobsUnavailableError
        If the bucket cannot be created within two minutes.
    """
    prepare_data_folder(settings)
    prepare_database(settings.system_database_url)
    retry_while_storage_is_away(open_blob_store(settings).prepare)()
    return 0
