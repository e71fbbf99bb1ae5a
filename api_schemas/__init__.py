"""The wire types of the service: what travels over HTTP, and nothing else.

``points`` and ``requests`` are what a caller sends; ``jobs``, ``results``, ``body_models`` and
``problems`` are what the service answers; ``images``, ``proposals``, ``initial_poses``, ``bodies``
and ``webhooks`` are both sides of their resources. ``openapi.json`` is the exported contract.
"""
