"""As the worker's own, but that fakes are told what to do by their environment."""

from service.process.confinement import forget_secrets

forget_secrets(also=("FAKE_",))
