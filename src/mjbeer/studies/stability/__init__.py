"""`mjbeer stability` simulates stiff and extreme scenes, and measures up to which timestep motions
stay stable."""
