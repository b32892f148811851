"""`mjbeer benchmark` and `mjbeer advise`: error against run time."""
