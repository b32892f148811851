"""Numerical errors that theory predicts; it imports `theory`, and no simulator."""
