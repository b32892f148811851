"""The exact theory of the can; it imports NumPy, SciPy and what every room uses, no simulator."""
