"""The sample that ships with the package."""
