"""What is derived from a fitted person: one module per kind, between two translations."""
