"""Simulates a scene with MuJoCo; it imports `theory` and `model`."""
