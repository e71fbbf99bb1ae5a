"""Notices of jobs' ends, signed and sent to whom the callers named (Standard Webhooks).

What is to be sent stands in the job's record (:mod:`service.engine.webhooks`), written in the
transaction that ends the job; here it is sent, by every API process, until it is accepted.
"""
