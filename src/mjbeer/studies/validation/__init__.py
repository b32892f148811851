"""`mjbeer validate`: checks of every model against exact theory, and the audit of the paper."""
