"""Pictures of people the body model has never seen, with the truth, and how well they are fitted.

The bodies are solved for from seeds the training never uses, posed by MakeHuman's own rig instead
of our SCAPE, and rendered by an independent renderer, Mitsuba 3 (the extra ``evaluation``), which
only ``python -m tests.accuracy.generate`` needs.
"""
