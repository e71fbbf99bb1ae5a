"""Processes that compute: forked from one server, given a task as bytes, answering with bytes.

Whoever owns the fork server (:mod:`.fork_server`) has two lanes: jobs (:mod:`.job_lane`), which
take as long as they may and tell of their progress, and questions that are answered within seconds
(:mod:`.quick_lane`). What runs in a child is in :mod:`.child`, and both lanes speak to it in the
same messages (:mod:`.messages`). An API asks the quick lane of its owner over a socket
(:mod:`.relay`).
"""
