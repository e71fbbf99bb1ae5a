"""What every process of the service stands on: folders, logs, kernels, retries."""
