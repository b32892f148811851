"""`mjbeer stability`: stiff and extreme scenes, and where stability ends."""
