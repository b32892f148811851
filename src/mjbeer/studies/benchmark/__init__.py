"""`mjbeer benchmark` measures error against run time, of mjbeer's models and of other tools."""
