"""The drawn world: cans on their board, and what an eye sees of them. It imports nothing else of drawing but opengl."""
