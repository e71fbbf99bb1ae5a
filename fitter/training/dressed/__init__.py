"""Drawn dressed people, and the small network that learns from them what people wear."""
