"""What a job is: its states, inputs, files and JSON."""
