"""The HTTP API: one module per resource, problems in one place. Loads no numerics."""
