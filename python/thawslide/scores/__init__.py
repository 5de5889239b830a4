"""Comparison of a sweep or a run with observations of an event."""
