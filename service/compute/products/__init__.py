"""Kinds of products: ``make`` in the module that has the name of the kind."""
