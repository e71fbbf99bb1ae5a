"""Read the body models and tell: ``python -m service.worker.body_models [FOLDER]``."""

from service.worker.body_models.described import describe
from service.worker.body_models.telling import tell

if __name__ == "__main__":
    tell(describe)
