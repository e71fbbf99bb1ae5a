"""The HTTP service around the fitter: API, job engine, workers and command line."""
