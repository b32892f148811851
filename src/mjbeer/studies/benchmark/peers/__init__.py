"""Other tools on the same scenes, to be timed beside MuJoCo."""
