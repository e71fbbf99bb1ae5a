"""The HTTP API: one module a resource, problems in one place. Loads no numerics."""
