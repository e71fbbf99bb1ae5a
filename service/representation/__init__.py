"""How jobs and their files are shown to callers."""
