"""Durable jobs: their records, who runs them, and the blobs they were made of and made.

DBOS owns *execution*: what a worker has done of a job, from which another continues when it dies;
the sending of notices is a workflow too. The record owns *what callers see* (state, progress,
events, results) and *who runs the job*: workers claim jobs there, and let those of the dead wait
again. The API enters by ``engine``, the worker by ``worker``.
"""
