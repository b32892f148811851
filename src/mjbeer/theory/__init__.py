"""The exact theory of the can; it imports NumPy, SciPy, `require` and `exceptions`, and no simulator."""
