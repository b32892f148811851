"""Pictures and videos of a trajectory; it imports `theory`, `output` and `model`."""
