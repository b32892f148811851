"""`mjbeer benchmark` measures error against run time; `mjbeer advise` picks a setting from what it measured."""
