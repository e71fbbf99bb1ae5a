"""Faults of what the service stands on, while jobs are being taken, run and answered."""
