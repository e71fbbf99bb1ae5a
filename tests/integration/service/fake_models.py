"""Tells of the fake pipeline's models: ``python -m tests.integration.service.fake_models``."""

from service.compute.model_reader import tell
from tests.integration.service.fake_pipeline import describe

if __name__ == "__main__":
    tell(describe)
