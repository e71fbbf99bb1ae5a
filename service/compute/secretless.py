"""Imported by every fork server before anything else: it and those it forks know no secrets."""

from service.process.confinement import forget_secrets

forget_secrets()
