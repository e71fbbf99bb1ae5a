"""``maquette prepare``: what API and workers expect to find, made before they start."""

from service.blobs import BlobsUnavailableError, open_blob_store
from service.engine.database import prepare_database
from service.settings import SettingError, Settings
from service.worker.patience import patient_with_storage


def prepare(settings: Settings) -> int:
    """Make the tables and the folder or bucket of the blobs; what is there already stays.

    Raises
    ------
    SettingError
        If the bucket cannot be made, after two minutes of trying.
    """
    prepare_database(settings.system_database_url)
    blobs = open_blob_store(settings)
    try:
        patient_with_storage(blobs.prepare)()
    except BlobsUnavailableError as error:
        name = "data_dir" if settings.blob_url is None else "blob_url"
        raise SettingError(str(error), name=name) from error
    return 0
