"""Durable jobs behind a small port.

``port`` defines what the API and the worker need; the rest implements it on DBOS, with the job's
own record in the same database. DBOS owns *execution*: what a worker has done of a job, from which
another continues when it dies. The record owns *what callers see* (state, progress, events,
results) and *who runs the job*: workers claim jobs there, and let those of the dead wait again.
"""
