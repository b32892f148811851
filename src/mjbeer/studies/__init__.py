"""Studies of the models, which share the files here; no study imports another."""
