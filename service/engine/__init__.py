"""Durable jobs behind a small port.

``port`` says what the API and the worker need; the rest implements it on DBOS, with the job's own
record in the same database. DBOS owns *execution*: claiming from the queue, checkpoints, running a
dead worker's jobs again. The record owns *what callers see*: state, progress, events, results. Both
change in one transaction when a job is accepted.
"""
