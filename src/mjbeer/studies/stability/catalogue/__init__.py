"""Stiff and extreme scenes, and those that random search found."""
