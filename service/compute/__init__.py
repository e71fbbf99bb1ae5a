"""The worker: claims jobs, runs each in a child process, and publishes the results."""
