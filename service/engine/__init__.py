"""Durable jobs behind a small port.

``port`` defines what the API and the worker need; the rest implements it on DBOS, with the job's
own record in the same database. DBOS owns *execution*: claiming from the queue, checkpoints,
rerunning a dead worker's jobs. The record owns *what callers see*: state, progress, events,
results. When a job is accepted, both change in one transaction.
"""
