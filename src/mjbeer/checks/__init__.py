"""Checks and their results, also as JSON, for the paper, the validation and the studies."""
