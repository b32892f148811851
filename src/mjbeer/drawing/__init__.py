"""Pictures and videos of a trajectory, and a scene in MuJoCo's viewer; it imports `theory`, `output` and `model`."""
