"""Each claim of the paper, with MuJoCo as the witness, a file a chapter; it imports the equations."""
