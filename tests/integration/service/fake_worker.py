"""A worker with the fake pipeline: ``python -m tests.integration.service.fake_worker``."""

FAKE = "tests.integration.service.fake_pipeline"


def main() -> None:
    # Imported here: every forked child imports this module again, and is to start quickly.
    from service.process.logs import configure_logging
    from service.settings import Settings
    from service.worker.main import run_worker

    settings = Settings()
    configure_logging(settings.log_level, settings.log_format)
    run_worker(settings, follow_stdin=True, pipeline=FAKE, preload=FAKE)


if __name__ == "__main__":
    main()
