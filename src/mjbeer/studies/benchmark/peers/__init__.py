"""Other tools, to be timed on the same scenes as MuJoCo."""
