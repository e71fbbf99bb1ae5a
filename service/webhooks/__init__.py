"""Notices of fits' ends, signed and sent to the receivers that callers named (Standard Webhooks).

When a notice is sent, and how often it is tried, is the engine's to say
(:mod:`service.jobs.notices`).
"""
