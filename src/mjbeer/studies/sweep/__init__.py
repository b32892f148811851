"""Many scenes in one call: it imports `theory`, `model`, `simulation` and `output`."""
