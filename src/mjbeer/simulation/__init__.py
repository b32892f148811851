"""From a scene to a trajectory; it imports `theory` and `model`."""
