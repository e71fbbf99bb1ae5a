"""Checks of what is sent, before it is stored or decoded."""
