"""What a can does, exactly; it imports NumPy, SciPy, `require` and `exceptions`, and no simulator."""
