"""The MuJoCo models of a scene; it imports `theory` and `output`."""
