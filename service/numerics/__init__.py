"""Processes that compute: forked from one server, given a task as bytes, answering with bytes.

Whoever owns the fork server (:mod:`.fork_server`) has a child for each job, which takes as long as
it may and tells of its progress, and a lane of children for questions that are answered within
seconds (:mod:`.quick_lane`). What runs in a child is in :mod:`.child`, and is spoken to in the same
messages (:mod:`.messages`). An API asks the quick lane of its owner over a socket (:mod:`.relay`).
"""
