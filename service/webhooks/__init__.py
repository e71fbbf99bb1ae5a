"""Notices of jobs' ends, signed and sent to the receivers that callers named (Standard Webhooks).

What is to be sent is in the job's record (:mod:`service.engine.webhooks`), written in the
transaction that ends the job; this package sends it, from any API process, until it is accepted.
"""
