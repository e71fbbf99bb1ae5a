"""Checks of everything the service depends on, before anything is started."""

from service.engine.database import check_database
from service.process.data_folder import prepare_data_folder
from service.settings import Settings
from service.worker.model_files import check_detector, check_models


def check_ground(settings: Settings) -> None:
    """Check data folder, models, detector and database; waits for an unavailable database.

    Raises
    ------
    SettingError
        If folder, models or detector cannot be used.
    DatabaseUnusableError
        If the database cannot be used.
    """
    prepare_data_folder(settings)
    check_models(settings)
    check_detector(settings)
    check_database(settings.system_database_url, sandbox=settings.sandbox)
