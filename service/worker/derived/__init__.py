"""What is derived from a fitted person: one module a kind, between two translations."""
