"""What every process of the service relies on: folders, logs, kernels, retries."""
