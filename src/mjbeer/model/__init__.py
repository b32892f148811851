"""A scene as a MuJoCo model; it imports `theory` and `output`."""
