"""`mjbeer stability`: stiff and extreme scenes, and the longest timesteps that are stable."""
