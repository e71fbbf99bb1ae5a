"""Which body models there are, and whether they can be used.

A worker loads no numerics, and its fork server is not to be waited for; so a process of its own
reads the models and tells (``telling``, ``described``), and whoever wants to know starts it and
listens (``asking``).
"""
