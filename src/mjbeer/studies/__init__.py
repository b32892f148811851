"""Studies of the models: validation, benchmark, stability. They share the files here, and none
imports another."""
