"""Checks, their results, and both as JSON: what the paper, the validation and the studies have in
common."""
