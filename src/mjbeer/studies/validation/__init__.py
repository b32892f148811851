"""`mjbeer validate`: checks of every model against exact theory, together with the audit of the
paper."""
