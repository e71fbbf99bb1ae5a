"""The worker: claims jobs, runs each in a child process, publishes what it leaves behind."""
